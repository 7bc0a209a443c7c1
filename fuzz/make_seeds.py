#!/usr/bin/env python3
"""Writes the seeds of the targets `image` and `ply` again: small files of every kind that the formats have.

Needs numpy, Pillow and OpenEXR. The files are in the repository; this says where they came from.
"""

import gzip
import pathlib
import struct
import zlib

import numpy as np
import OpenEXR
from PIL import Image

SEEDS = pathlib.Path(__file__).parent / "seeds"


def texels(n, channels):
    """A picture with something in every channel."""
    y, x = np.mgrid[0:n, 0:n]
    planes = [(x * 17 + y * 5 * (c + 1)) % 256 for c in range(channels)]
    return np.stack(planes, axis=-1).astype(np.uint8)


def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(name, color_type, depth, channels, n=8, extra=b"", interlace=0):
    bits = n * channels * depth
    if interlace:
        rows = b""
        for x0, y0, dx, dy in [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]:
            w, h = (n - x0 + dx - 1) // dx, (n - y0 + dy - 1) // dy
            rows += b"".join(b"\0" + bytes((w * channels * depth + 7) // 8) for _ in range(h))
    else:
        row = bytes((i * 37) % (1 << min(depth, 8)) if color_type == 3 else (i * 37) % 256 for i in range((bits + 7) // 8))
        if color_type == 3:
            row = bytes(len(row))
        # Every filter in turn.
        rows = b"".join(bytes([y % 5]) + row for y in range(n))
    header = struct.pack(">IIBBBBB", n, n, depth, color_type, 0, 0, interlace)
    body = png_chunk(b"IHDR", header) + extra + png_chunk(b"IDAT", zlib.compress(rows)) + png_chunk(b"IEND", b"")
    (SEEDS / "image" / f"{name}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def pngs():
    for depth in (1, 2, 4, 8, 16):
        png(f"grey{depth}", 0, depth, 1)
    png("rgb8", 2, 8, 3)
    png("rgb16", 2, 16, 3)
    png("grey_alpha8", 4, 8, 2)
    png("rgba8", 6, 8, 4)
    png("rgba16", 6, 16, 4)
    palette = png_chunk(b"PLTE", bytes(range(12)))
    png("palette2", 3, 2, 1, extra=palette + png_chunk(b"tRNS", b"\0\x80"))
    png("interlaced", 6, 8, 4, interlace=1)
    png("transparent_rgb", 2, 8, 3, extra=png_chunk(b"tRNS", bytes(6)) + png_chunk(b"gAMA", struct.pack(">I", 45455)))


def jpegs():
    rgb, grey = Image.fromarray(texels(20, 3)), Image.fromarray(texels(20, 1)[:, :, 0])
    to = SEEDS / "image"
    for name, image, options in [
        ("baseline", rgb, {"subsampling": 0}),
        ("subsampled", rgb, {"subsampling": 2, "quality": 30}),
        ("progressive", rgb, {"progressive": True, "optimize": True}),
        ("restarts", rgb, {"restart_marker_blocks": 1}),
        ("grey", grey, {}),
        ("cmyk", rgb.convert("CMYK"), {}),
    ]:
        image.save(to / f"{name}.jpg", **options)


def floats():
    to = SEEDS / "image"
    values = texels(3, 3).astype("<f4") / 64
    (to / "small.pfm").write_bytes(b"PF\n3 3\n-1.0\n" + values.tobytes())
    (to / "big_endian.pfm").write_bytes(b"PF\n3 3\n2.5\n" + values.astype(">f4").tobytes())
    (to / "grey.pfm").write_bytes(b"Pf\n3 3\n-1\n" + values[:, :, 0].tobytes())
    rgbe = np.concatenate([texels(8, 3), np.full((8, 8, 1), 129, np.uint8)], axis=-1)
    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2.0\n\n-Y 8 +X 8\n"
    (to / "flat.hdr").write_bytes(head + rgbe.tobytes())
    rows = b""
    for row in rgbe:
        rows += bytes([2, 2, 0, 8])
        for c in range(3):
            rows += bytes([4]) + row[:4, c].tobytes() + bytes([128 + 4, row[4, c]])
        rows += bytes([128 + 8, 129])
    (to / "runs.hdr").write_bytes(head.replace(b"EXPOSURE=2.0\n", b"") + rows)


def exrs():
    rgb = texels(9, 3).astype(np.float32) / 64
    kinds = {
        "none": OpenEXR.NO_COMPRESSION,
        "rle": OpenEXR.RLE_COMPRESSION,
        "zips": OpenEXR.ZIPS_COMPRESSION,
        "zip": OpenEXR.ZIP_COMPRESSION,
        "piz": OpenEXR.PIZ_COMPRESSION,
        "pxr24": OpenEXR.PXR24_COMPRESSION,
        "b44": OpenEXR.B44_COMPRESSION,
        "b44a": OpenEXR.B44A_COMPRESSION,
        "dwaa": OpenEXR.DWAA_COMPRESSION,
    }
    for name, compression in kinds.items():
        for kind in (np.float16, np.float32):
            if kind == np.float16 and name in ("none", "rle", "zips"):
                continue
            header = {"compression": compression, "type": OpenEXR.scanlineimage}
            path = SEEDS / "image" / f"{name}_{np.dtype(kind).name}.exr"
            OpenEXR.File(header, {"RGB": rgb.astype(kind)}).write(str(path))
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    grey = {"Y": rgb[:, :, 0].copy(), "id": texels(9, 1)[:, :, 0].astype(np.uint32)}
    OpenEXR.File(header, grey).write(str(SEEDS / "image" / "grey.exr"))
    for name, mode in [("tiled", OpenEXR.ONE_LEVEL), ("mip_levels", OpenEXR.MIPMAP_LEVELS)]:
        tiles = OpenEXR.TileDescription()
        tiles.xSize, tiles.ySize, tiles.mode, tiles.roundingMode = 4, 4, mode, OpenEXR.ROUND_DOWN
        header = {"compression": OpenEXR.PIZ_COMPRESSION, "type": OpenEXR.tiledimage, "tiles": tiles}
        try:
            OpenEXR.File(header, {"RGB": rgb}).write(str(SEEDS / "image" / f"{name}.exr"))
        except Exception as error:  # Some versions of the module write one level only.
            print(f"{name}: {error}")


def plys():
    to = SEEDS / "ply"
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)]
    faces = [(0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (0, 1, 2, 3, 4)]
    head = "ply\nformat {} 1.0\ncomment seed\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    plain = head + "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    text = plain.format("ascii") + "".join("%g %g %g\n" % p for p in points)
    text += "".join(" ".join(map(str, (len(f), *f))) + "\n" for f in faces)
    (to / "ascii.ply").write_text(text)
    (to / "packed.ply.gz").write_bytes(gzip.compress(text.encode(), mtime=0))
    for name, order in [("binary_little_endian", "<"), ("binary_big_endian", ">")]:
        body = b"".join(struct.pack(order + "3f", *p) for p in points)
        body += b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)
        (to / f"{name}.ply").write_bytes(plain.format(name).encode() + body)
        # Everything that a vertex may have, of other types, and an element that nothing is read of.
        rich = head + "".join(f"property double n{a}\n" for a in "xyz")
        rich += "property float s\nproperty float t\n"
        rich += "".join(f"property uchar {c}\n" for c in ("red", "green", "blue", "alpha"))
        rich += "element edge 1\nproperty list ushort float weights\nproperty short id\n"
        rich += "element face 2\nproperty uchar flags\nproperty list uint uint vertex_index\nend_header\n"
        body = b"".join(
            struct.pack(order + "3f3d2f4B", *p, 0, 0, 1, p[0], p[1], 255, 128, i, 255) for i, p in enumerate(points)
        )
        body += struct.pack(order + "H2fh", 2, 0.5, 0.25, -3)
        body += b"".join(struct.pack(f"{order}BI{len(f)}I", 7, len(f), *f) for f in faces[:2])
        (to / f"rich_{name}.ply").write_bytes(rich.format(name).encode() + body)
    coloured = head + "property ushort red\nproperty ushort green\nproperty ushort blue\n"
    coloured += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    coloured = coloured.format("ascii") + "".join("%g %g %g 65535 0 99\n" % p for p in points) + "3 0 1 2\n"
    (to / "coloured.ply").write_text(coloured)


if __name__ == "__main__":
    for name in ("image", "ply"):
        (SEEDS / name).mkdir(parents=True, exist_ok=True)
    pngs()
    jpegs()
    floats()
    exrs()
    plys()
