"""100 steps of an FMU of FMI 3.0 in fmuloader: python with_fmuloader.py NAME.fmu"""

import sys
import xml.etree.ElementTree as ET
import zipfile

from fmuloader.fmi3 import Fmi3Slave

STEP = 1e-3


def main() -> None:
    """Steps with the first input moved, prints the last numbers that are not 0."""
    path = sys.argv[1]
    with zipfile.ZipFile(path) as archive:
        root = ET.fromstring(archive.read("modelDescription.xml"))
    # it reads as many values as references: numbers, no arrays
    numbers = [v for v in root.iter("Float64") if v.find("Dimension") is None]
    outputs = [v for v in numbers if v.attrib["causality"] == "output"]
    moved = next(v for v in numbers if v.attrib["causality"] == "input")
    identifier = root.find("CoSimulation").attrib["modelIdentifier"]
    slave = Fmi3Slave(path, model_identifier=identifier)
    slave.instantiate_co_simulation(
        "contact", instantiation_token=root.attrib["instantiationToken"]
    )
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    start = float(moved.attrib["start"])
    for k in range(100):
        slave.set_float64([int(moved.attrib["valueReference"])], [start + 1e-8 * k])
        slave.do_step(k * STEP, STEP)
    values = slave.get_float64([int(v.attrib["valueReference"]) for v in outputs])
    for variable, value in zip(outputs, values, strict=True):
        if value != 0.0:
            print(f"  {variable.attrib['name']:<28}{value:.15g}")
    slave.terminate()
    slave.free_instance()


if __name__ == "__main__":
    main()
