"""100 steps of an FMU in Ecos: python with_ecospy.py NAME.fmu"""

import sys
import xml.etree.ElementTree as ET
import zipfile

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

STEP = 1e-3


def main() -> None:
    """Steps with the first input moved, prints the last Real outputs that are not 0."""
    path = sys.argv[1]
    print(f"Ecos {EcosLib.version()}")
    with zipfile.ZipFile(path) as archive:
        root = ET.fromstring(archive.read("modelDescription.xml"))
    variables = [v for v in root.iter("ScalarVariable") if v[0].tag == "Real"]
    # FMI 3.0: Ecos reads numbers, no arrays
    variables += [v for v in root.iter("Float64") if v.find("Dimension") is None]
    outputs = [v.attrib["name"] for v in variables if v.attrib["causality"] == "output"]
    moved = next(v for v in variables if v.attrib["causality"] == "input")
    start = float((moved if moved.tag == "Float64" else moved[0]).attrib["start"])
    with EcosSimulationStructure() as structure:
        structure.add_model("contact", path)
        with EcosSimulation(structure=structure, step_size=STEP) as simulation:
            simulation.init()
            for k in range(100):
                simulation.set_real(f"contact::{moved.attrib['name']}", start + 1e-8 * k)
                simulation.step()
            for name in outputs:
                value = simulation.get_real(f"contact::{name}")
                if value != 0.0:
                    print(f"  {name:<28}{value:.15g}")


if __name__ == "__main__":
    main()
