"""terminalsAndIcons of FMI 3.0, and of FMI 2.0 since its version 2.0.4: the wheelset, its wheels,
its rails, and a drawn icon. The file is that of FMI 3.0 in both; FMI 3.0 alone has arrays in it.
"""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from railpatch.case.types import SIDES
from railpatch.fmu.table import Item, Variable, items_of

FOLDER = "terminalsAndIcons"
# of the icon, in its own units, which are those of model.png
SIZE = 128
ICON = f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}">
<title>A wheel on a rail, seen along the track</title>
<rect width="{SIZE}" height="{SIZE}" fill="#ffffff"/>
<rect x="3" y="10" width="81" height="16" fill="#465262"/>
<g fill="#96a2b0">
<rect x="51" y="6" width="21" height="48"/>
<path d="M31 51 H100 V74 L31 70 Z"/>
<ellipse cx="31" cy="73" rx="9" ry="14"/>
</g>
<g fill="#465262">
<path d="M45 92 V79 Q45 72 66 72 Q88 72 88 79 V92 Z"/>
<rect x="61" y="90" width="11" height="28"/>
<rect x="28" y="114" width="77" height="9"/>
</g>
<ellipse cx="66" cy="72" rx="10" ry="2" fill="#d6452e"/>
</svg>
"""


def terminals_xml(variables: list[Variable], version: int) -> str:
    """terminalsAndIcons.xml. version: of the FMU."""
    items = [i for i in items_of(variables, version) if i.first.causality in ("input", "output")]
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<fmiTerminalsAndIcons fmiVersion="3.0">',
        "  <GraphicalRepresentation>",
        '    <CoordinateSystem x1="0" y1="0" x2="128" y2="128" '
        'suggestedScalingFactorTo_mm="0.15"/>',
        '    <Icon x1="0" y1="0" x2="128" y2="128"/>',
        "  </GraphicalRepresentation>",
        "  <Terminals>",
    ]
    for name, description, found in terminals_of(items):
        lines.append(
            f'    <Terminal name={quoteattr(name)} matchingRule="bus" '
            f"description={quoteattr(description)}>"
        )
        lines += [
            f"      <TerminalMemberVariable variableName={quoteattr(item.name)} "
            f'memberName={quoteattr(member)} variableKind="signal"/>'
            for member, item in found.items()
        ]
        lines.append("    </Terminal>")
    return "\n".join([*lines, "  </Terminals>", "</fmiTerminalsAndIcons>", ""])


def terminals_of(items: list[Item]) -> list[tuple[str, str, dict[str, Item]]]:
    """Name, description and members of each terminal that has any."""
    sides = [side for side in SIDES if any(side in item.name.split(".") for item in items)]
    found = [("wheelset", "Motion of the wheelset, force and moment of all wheels on it")]
    for side in sides:
        found.append((f"{side}_wheel", f"Deviation of the {side} wheel, force and moment on it"))
        found.append((f"{side}_rail", f"Deviation of the {side} rail or roller"))
    if not any(item.name.startswith("wheelset.") for item in items):
        found = [("contact", "Load and creepages of the patch, force and moment on the wheel")]
    listed = [(name, text, members_of(items, name)) for name, text in found]
    return [(name, text, members) for name, text, members in listed if members]


def members_of(items: list[Item], terminal: str) -> dict[str, Item]:
    """By what they are called in a terminal; where an input and what is found of it have the same
    name (z of a wheelset), the input."""
    members: dict[str, Item] = {}
    for item in items:
        member = member_of(item.name, terminal)
        if member is None or (member in members and members[member].first.causality == "input"):
            continue
        members[member] = item
    return members


def member_of(name: str, terminal: str) -> str | None:
    """What a variable is called in a terminal; None: it is not in it."""
    parts = name.split(".")
    if terminal == "contact":
        return name
    if terminal == "wheelset":
        if parts[0] == "wheelset" and len(parts) == 2:
            return parts[1]
        return name if plain(name) in ("force", "moment", "z") else None
    side, body = terminal.split("_")
    owner = "wheelset" if body == "wheel" else "track"
    if parts[:2] == [owner, side]:
        return ".".join(parts[2:])
    if body == "wheel" and parts[0] == side and plain(".".join(parts[1:])) in ("force", "moment"):
        return parts[1]
    return None


def plain(name: str) -> str:
    """Without the component of a vector."""
    return name.partition("[")[0]
