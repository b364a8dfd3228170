"""model.png: a wheel on a rail, seen along the track; drawn here, so nothing else is needed."""

from __future__ import annotations

import struct
import zlib

import numpy as np

SIZE = 128  # pixels
FINE = 4  # samples of a pixel in each direction
BACKGROUND, STEEL, DARK, SPOT = (255, 255, 255), (150, 162, 176), (70, 82, 98), (214, 69, 46)


def model_png() -> bytes:
    """The file."""
    axis = (np.arange(SIZE * FINE) + 0.5) / (SIZE * FINE)
    x, y = np.meshgrid(axis, axis)
    image = np.empty((*x.shape, 3))
    image[:] = BACKGROUND
    for colour, shape in shapes(x, y):
        image[shape] = colour
    pixels = image.reshape(SIZE, FINE, SIZE, FINE, 3).mean(axis=(1, 3)).round().astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    head = struct.pack(">IIBBBBB", SIZE, SIZE, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(rows, 9))
        + chunk(b"IEND", b"")
    )


def chunk(kind: bytes, content: bytes) -> bytes:
    """One part of a PNG: length, kind, content, checksum."""
    checksum = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)


def shapes(x: np.ndarray, y: np.ndarray) -> list[tuple[tuple[int, int, int], np.ndarray]]:
    """Colour and area, from back to front; x to the right, y down, both 0 to 1."""
    cone = 0.56 + 0.06 * (x - 0.52)  # the tread, which is conical
    flange = np.hypot((x - 0.24) / 0.07, (y - 0.57) / 0.11) < 1
    tread = (x > 0.24) & (x < 0.78) & (y > 0.40) & (y < cone)
    web = (x > 0.40) & (x < 0.56) & (y > 0.05) & (y < 0.42)
    axle = (x > 0.02) & (x < 0.66) & (y > 0.08) & (y < 0.20)
    head = (np.abs(x - 0.52) < 0.17) & (y < 0.72) & (y > 0.56 + 1.4 * (x - 0.52) ** 2)
    stem = (np.abs(x - 0.52) < 0.045) & (y > 0.70) & (y < 0.92)
    foot = (np.abs(x - 0.52) < 0.30) & (y > 0.89) & (y < 0.96)
    patch = np.hypot((x - 0.52) / 0.075, (y - 0.56) / 0.014) < 1
    wheel = flange | tread | web
    return [(DARK, axle), (STEEL, wheel), (DARK, head | stem | foot), (SPOT, patch)]
