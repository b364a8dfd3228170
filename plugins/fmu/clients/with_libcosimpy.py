"""100 steps of an FMU in libcosim: python with_libcosimpy.py NAME.fmu"""

import sys
import xml.etree.ElementTree as ET
import zipfile

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

STEP = 1e-3


def main() -> None:
    """Steps with the first input moved, prints the last Real outputs that are not 0."""
    log_output_level(CosimLogLevel.INFO)
    path = sys.argv[1]
    with zipfile.ZipFile(path) as archive:
        root = ET.fromstring(archive.read("modelDescription.xml"))
    variables = [v for v in root.iter("ScalarVariable") if v[0].tag == "Real"]
    number = {v.attrib["name"]: int(v.attrib["valueReference"]) for v in variables}
    outputs = [v.attrib["name"] for v in variables if v.attrib["causality"] == "output"]
    moved = next(v for v in variables if v.attrib["causality"] == "input")
    execution = CosimExecution.from_step_size(round(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(path, "contact"))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    manipulator = CosimManipulator.create_override()
    execution.add_manipulator(manipulator)
    start = float(moved[0].attrib["start"])
    name = moved.attrib["name"]
    for k in range(100):
        value = start + 1e-8 * k
        manipulator.slave_real_values(slave, [number[name]], [value])
        if not execution.step():
            sys.exit(f"step {k} failed: {execution.status()}")
    print(execution.status())
    values = observer.last_real_values(slave, [number[n] for n in outputs])
    for name, value in zip(outputs, values, strict=True):
        if value != 0.0:
            print(f"  {name:<28}{value:.15g}")


if __name__ == "__main__":
    main()
