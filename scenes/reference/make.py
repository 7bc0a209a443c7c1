#!/usr/bin/env python3
"""Makes scenes, what they need, and their reference pictures by Mitsuba 3.

    python scenes/reference/make.py [NAME ...] [--passes 32] [--spp 256] [--scenes-only]

needs the packages `mitsuba` (3.9.1 was used) and `numpy`. Each scene below is described once, in a form from
which both come: `NAME.toml` for zrak, and a dictionary for Mitsuba. Meshes and pictures that they share are in
`assets/`. With the same numbers of passes and samples the pictures are made again as they are.

A scene's picture is the mean of independent passes with different seeds, `NAME_stderr.npy` the standard error of
each value by the spread of the passes. See README.md.
"""

import argparse
import pathlib
import struct
import zlib

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
HERE = pathlib.Path(__file__).resolve().parent
ASSETS = HERE / "assets"
SIZE = 64
MAX_DEPTH = 50
T4, T3 = mi.ScalarTransform4f, mi.ScalarTransform3f


# --------------------------------------------------------------------------------------------------- transforms


def translate(x, y, z):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def scale(x, y=None, z=None):
    return np.diag([x, x if y is None else y, x if z is None else z, 1.0])


def rotate(axis, degrees):
    """Counter-clockwise seen from the axis' tip."""
    a = np.asarray(axis, float) / np.linalg.norm(axis)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    k = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    m = np.eye(4)
    m[:3, :3] = c * np.eye(3) + s * k + (1 - c) * np.outer(a, a)
    return m


def steps(m):
    """A map as the steps of a zrak `transform`."""
    return [] if np.allclose(m, np.eye(4)) else [{"matrix": np.asarray(m)[:3].tolist()}]


def to_world(m):
    return T4(np.asarray(m, float))


# ------------------------------------------------------------------------------------------------------- writing


def toml(value):
    """A value in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (int, np.integer)):
        return str(value)
    if isinstance(value, (float, np.floating)):
        text = repr(round(float(value), 9))
        return text[:-2] if text.endswith(".0") else text
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    return "[" + ", ".join(toml(v) for v in value) + "]"


def rgb(color):
    return {"type": "rgb", "value": [float(x) for x in color]}


def write_png(name, pixels):
    """8-bit picture: [height, width] grey or [height, width, 3]."""
    pixels = np.asarray(pixels, np.uint8)
    kind = 0 if pixels.ndim == 2 else 2
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(tag, data):
        body = tag + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    head = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, kind, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    (ASSETS / name).write_bytes(data)


def write_pfm(name, pixels):
    """Picture of 32-bit floating-point numbers, [height, width, 3]."""
    h, w, _ = pixels.shape
    data = pixels[::-1].astype("<f4").tobytes()
    (ASSETS / name).write_bytes(f"PF\n{w} {h}\n-1.0\n".encode() + data)


def write_ply(name, positions, normals, uvs, triangles):
    """Binary mesh."""
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}"]
    header += [f"property float {x}" for x in ("x", "y", "z", "nx", "ny", "nz", "u", "v")]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    vertices = np.hstack([positions, normals, uvs]).astype("<f4").tobytes()
    faces = b"".join(struct.pack("<B3i", 3, *t) for t in triangles)
    (ASSETS / name).write_bytes("\n".join(header).encode() + vertices + faces)


# -------------------------------------------------------------------------------------------------------- assets


def environment_picture():
    """A smooth sky with a soft sun, another glow, and a ground: 64 x 32, as zrak has it."""
    w, h = 64, 32
    u, v = np.meshgrid((np.arange(w) + 0.5) / w, (np.arange(h) + 0.5) / h)
    # zrak: -z in the middle, +x a quarter to its right.
    phi, theta = (u - 0.5) * 2 * np.pi, v * np.pi
    d = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], -1)

    def glow(direction, kappa):
        direction = np.asarray(direction, float) / np.linalg.norm(direction)
        return np.exp(kappa * (d @ direction - 1))[..., None]

    up = 0.5 + 0.5 * d[..., 1:2]
    sky = (1 - up) * np.array([0.25, 0.22, 0.2]) + up * np.array([0.35, 0.55, 0.9])
    sky = sky + glow([0.7, 0.6, 0.5], 18) * np.array([5.0, 4.2, 3.0])
    return (sky + glow([-0.8, 0.15, 0.6], 8) * np.array([0.9, 0.25, 0.5])).astype(np.float32)


def mitsuba_environment(picture):
    """The same for Mitsuba, whose first and last row are the poles, and whose middle is +z. Its linear
    interpolation on twice as many rows gives just what zrak's gives."""
    centres = np.roll(picture, picture.shape[1] // 2, axis=1)
    h = len(centres)
    rows = np.empty((2 * h + 1, *centres.shape[1:]), np.float32)
    rows[1::2] = centres
    rows[2:-1:2] = 0.5 * (centres[1:] + centres[:-1])
    rows[0], rows[-1] = centres[0], centres[-1]
    return rows


def hills(u, v):
    """Height and its derivatives of a gentle landscape over the unit square."""
    a, b = 2 * np.pi * 1.5, 2 * np.pi
    height = 0.02 * (np.sin(a * u) * np.cos(b * v) + 0.6 * np.cos(b * (u + v)))
    du = 0.02 * (a * np.cos(a * u) * np.cos(b * v) - 0.6 * b * np.sin(b * (u + v)))
    dv = 0.02 * (-b * np.sin(a * u) * np.sin(b * v) - 0.6 * b * np.sin(b * (u + v)))
    return height, du, dv


def make_assets():
    ASSETS.mkdir(exist_ok=True)
    rng = np.random.default_rng(7)
    write_pfm("sky.pfm", environment_picture())
    write_png("tiles.png", rng.integers(20, 256, (6, 8, 3)))
    write_png("amount.png", rng.integers(0, 256, (8, 8)))
    # Bumps: the slope of `hills`, as normals and as heights.
    n = 64
    u, v = np.meshgrid((np.arange(n) + 0.5) / n, 1 - (np.arange(n) + 0.5) / n)
    height, du, dv = hills(u, v)
    normal = np.stack([-2 * du, -2 * dv, np.ones_like(du)], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    write_png("normals.png", np.rint((normal[::2, ::2] * 0.5 + 0.5) * 255))
    write_pfm("heights.pfm", np.repeat(height[..., None] + 0.1, 3, -1))
    # A patch of the landscape as a mesh, z upwards, over [-1, 1]^2.
    n = 20
    u, v = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n)
    height, du, dv = hills(u, v)
    p = np.stack([2 * u - 1, 2 * v - 1, 2 * height], -1).reshape(-1, 3)
    normal = np.stack([-du, -dv, np.ones_like(du)], -1).reshape(-1, 3)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.vstack([np.stack([i, i + 1, i + n + 2], -1), np.stack([i, i + n + 2, i + n + 1], -1)])
    write_ply("hills.ply", p, normal, np.stack([u, v], -1).reshape(-1, 2), triangles)


# ------------------------------------------------------------------------------------------- a BSDF without equal


class DiffuseTransmission(mi.BSDF):
    """Reflects and transmits evenly."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.r, self.t = mi.Color3f(props["reflectance"]), mi.Color3f(props["transmittance"])
        reflection = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        transmission = mi.BSDFFlags.DiffuseTransmission | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [reflection, transmission]
        self.m_flags = reflection | transmission

    def eval_pdf(self, ctx, si, wo, active=True):
        cos = dr.abs(wo.z) * dr.inv_pi
        same = wo.z * si.wi.z > 0
        value = dr.select(same, self.r, self.t) * cos
        return dr.select(active, value, 0.0), dr.select(active, 0.5 * cos, 0.0)

    def eval(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[1]

    def sample(self, ctx, si, s1, s2, active=True):
        w = mi.warp.square_to_cosine_hemisphere(s2)
        same = s1 < 0.5
        w.z = dr.select(same == (si.wi.z > 0), w.z, -w.z)
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo, bs.eta = w, 1.0
        bs.sampled_component = dr.select(same, mi.UInt32(0), mi.UInt32(1))
        reflection, transmission = mi.UInt32(+mi.BSDFFlags.DiffuseReflection), mi.UInt32(+mi.BSDFFlags.DiffuseTransmission)
        bs.sampled_type = dr.select(same, reflection, transmission)
        value, bs.pdf = self.eval_pdf(ctx, si, w, active)
        active &= bs.pdf > 0
        return bs, dr.select(active, value / bs.pdf, 0.0)

    def traverse(self, callback):
        pass

    def to_string(self):
        return "DiffuseTransmission[]"


class Correlated(mi.BSDF):
    """A rough BSDF of Mitsuba's with the masking and shadowing of zrak and pbrt, which are correlated by height:
    1 / (1 + a + b) instead of 1 / ((1 + a) (1 + b)). Heitz, *Understanding the Masking-Shadowing Function*, 2014."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.inner, self.alphas = props["bsdf"], [props["alpha_u"], props["alpha_v"]]
        self.m_components = [self.inner.flags(i) for i in range(self.inner.component_count())]
        self.m_flags = self.inner.flags()

    def ratio(self, si, wo):
        alpha_u, alpha_v = (a if isinstance(a, float) else a.eval_1(si) for a in self.alphas)

        def masked(w):
            slope2 = (dr.square(alpha_u * w.x) + dr.square(alpha_v * w.y)) / dr.square(w.z)
            return 0.5 * (dr.sqrt(1 + slope2) - 1)

        a, b = masked(si.wi), masked(wo)
        # Infinite at the horizon, where nothing is reflected.
        ratio = (1 + a) * (1 + b) / (1 + a + b)
        return dr.select(dr.isfinite(ratio), ratio, 1.0)

    def sample(self, ctx, si, s1, s2, active=True):
        bs, weight = self.inner.sample(ctx, si, s1, s2, active)
        return bs, weight * self.ratio(si, bs.wo)

    def eval(self, ctx, si, wo, active=True):
        return self.inner.eval(ctx, si, wo, active) * self.ratio(si, wo)

    def pdf(self, ctx, si, wo, active=True):
        return self.inner.pdf(ctx, si, wo, active)

    def eval_pdf(self, ctx, si, wo, active=True):
        value, pdf = self.inner.eval_pdf(ctx, si, wo, active)
        return value * self.ratio(si, wo), pdf

    def traverse(self, callback):
        pass

    def to_string(self):
        return "Correlated[]"


mi.register_bsdf("diffusetransmission", DiffuseTransmission)
mi.register_bsdf("correlated", Correlated)


FLIP = np.array([[1.0, 0, 0], [0, -1, 1], [0, 0, 1]])


def flipped(value):
    """A description for Mitsuba whose textures have v turned around."""
    if not isinstance(value, dict):
        return value
    value = {k: flipped(v) for k, v in value.items()}
    if value.get("type") == "bitmap":
        value["to_uv"] = T3(np.array(value["to_uv"].matrix, float) @ FLIP)
    return value


def correlated(bsdf, alpha_u, alpha_v=None):
    """A rough BSDF with correlated masking and shadowing."""
    return {"type": "correlated", "bsdf": bsdf, "alpha_u": alpha_u, "alpha_v": alpha_u if alpha_v is None else alpha_v}


# --------------------------------------------------------------------------------------------------------- scenes


class Scene:
    """A scene in both forms."""

    def __init__(self, name, about):
        self.name, self.about = name, about
        self.toml = {"background": [], "textures": [], "materials": [], "media": [], "meshes": []}
        self.objects, self.prototypes, self.lights = [], [], []
        self.textures, self.bsdfs, self.media = {}, {}, {}
        self.mitsuba = {"type": "scene", "integrator": {"type": "path", "max_depth": MAX_DEPTH, "rr_depth": 16}}

    # What there is in general.

    def camera(self, origin, target, vfov=40.0, lens=None, height=None, up=(0, 1, 0)):
        fields = {"look_from": origin, "look_at": target, "vup": up, "vfov_deg": vfov, "width": SIZE, "height": SIZE}
        matrix = T4().look_at(origin=[float(x) for x in origin], target=[float(x) for x in target], up=[float(x) for x in up])
        sensor = {"type": "perspective", "fov": vfov, "fov_axis": "y"}
        if lens is not None:
            radius, distance = lens
            fields["defocus_angle_deg"] = 2 * np.degrees(np.arctan(radius / distance))
            fields["focus_distance"] = distance
            sensor = {"type": "thinlens", "fov": vfov, "fov_axis": "y", "aperture_radius": radius, "focus_distance": distance}
        if height is not None:
            fields["projection"] = {"kind": "orthographic", "height": height}
            sensor = {"type": "orthographic"}
            matrix = matrix @ T4().scale([height / 2, height / 2, 1])
        self.toml["camera"] = fields
        film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"}
        self.mitsuba["sensor"] = {**sensor, "near_clip": 1e-3, "to_world": matrix, "film": film, "sampler": {"type": "independent"}}

    def constant(self, color):
        self.toml["background"] = {"kind": "constant", "color": color}
        self.mitsuba["environment"] = {"type": "constant", "radiance": rgb(color)}

    def sky(self, turn=np.eye(4), strength=1.0):
        self.toml["background"] = {"kind": "image", "path": "assets/sky.pfm", "strength": strength, "transform": steps(turn)}
        picture = mi.Bitmap(mitsuba_environment(environment_picture()))
        self.mitsuba["environment"] = {"type": "envmap", "bitmap": picture, "scale": strength, "to_world": to_world(turn)}

    # Textures.

    def image(self, name, file, filter="bilinear", wrap="repeat", uv=None, raw=False):
        """`uv` is a 2x3 matrix, applied to (u, v, 1)."""
        fields = {"kind": "image", "path": f"assets/{file}", "filter": filter, "wrap_u": wrap, "wrap_v": wrap}
        if uv is not None:
            fields["mapping"] = {"kind": "uv_affine", "matrix": uv}
        self.toml["textures"].append((name, fields))
        # Mitsuba has v downwards.
        m = np.vstack([np.eye(3)[:2] if uv is None else np.asarray(uv, float), [0, 0, 1]])
        m = FLIP @ m
        bitmap = mi.Bitmap(str(ASSETS / file))
        self.textures[name] = {
            "type": "bitmap", "bitmap": bitmap, "filter_type": filter, "wrap_mode": wrap,
            "raw": raw or file.endswith(".pfm"), "format": "variant", "to_uv": T3(m),
        }
        return name

    def texture(self, value):
        return self.textures[value] if isinstance(value, str) else rgb(value)

    def number(self, value):
        return self.textures[value] if isinstance(value, str) else float(value)

    # Materials.

    def material(self, name, fields, bsdf, twosided=True):
        self.toml["materials"].append((name, fields))
        self.bsdfs[name] = {"type": "twosided", "bsdf": bsdf} if twosided else bsdf
        return name

    def diffuse(self, name, color):
        return self.material(name, {"kind": "lambertian", "color": color}, {"type": "diffuse", "reflectance": self.texture(color)})

    def conductor(self, name, eta, k, alpha=None):
        fields = {"kind": "conductor", "metal": {"kind": "index", "eta": eta, "k": k}}
        bsdf = {"type": "conductor", "eta": rgb(eta), "k": rgb(k)}
        if alpha is not None:
            u, v = alpha
            fields["roughness"] = {"u": u} if u == v else {"u": u, "v": v}
            alphas = [self.number(u), self.number(v)]
            bsdf |= {"type": "roughconductor", "distribution": "ggx", "alpha_u": alphas[0], "alpha_v": alphas[1]}
            bsdf = correlated(bsdf, *alphas)
        return self.material(name, fields, bsdf)

    def dielectric(self, name, ior, alpha=None):
        fields, bsdf = {"kind": "dielectric", "ior": ior}, {"type": "dielectric", "int_ior": ior, "ext_ior": 1.0}
        if alpha is not None:
            fields = {"kind": "rough_dielectric", "ior": ior, "roughness": {"u": alpha}}
            bsdf |= {"type": "roughdielectric", "distribution": "ggx", "alpha": alpha}
            bsdf = correlated(bsdf, alpha)
        return self.material(name, fields, bsdf, twosided=False)

    def surface(self, name, base, bsdf, **fields):
        """Another material with more about it, whose Mitsuba form is given."""
        return self.material(name, {"kind": "surface", "base": base, **fields}, bsdf, twosided=False)

    def lamp(self, name, color):
        """Shines on its front side only; what it is for Mitsuba is said where it is placed."""
        self.toml["materials"].append((name, {"kind": "diffuse_light", "color": color, "sides": "front"}))
        self.bsdfs[name] = ("lamp", {"type": "area", "radiance": self.texture(color)})
        return name

    # Objects.

    def place(self, material, shape, medium=None, flips=False):
        shape = dict(shape)
        bsdf = flipped(self.bsdfs[material]) if flips else self.bsdfs[material]
        if isinstance(bsdf, tuple):
            shape["emitter"] = bsdf[1]
            shape["bsdf"] = {"type": "diffuse", "reflectance": rgb([0, 0, 0])}
        else:
            shape["bsdf"] = bsdf
        if medium is not None:
            shape["interior"] = self.media[medium]
        self.mitsuba[f"shape{len(self.mitsuba)}"] = shape

    def quad(self, corner, u, v, material):
        self.objects.append({"kind": "quad", "corner": corner, "u": u, "v": v, "material": material})
        corner, u, v = (np.asarray(x, float) for x in (corner, u, v))
        m = np.eye(4)
        n = np.cross(u, v)
        m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = u / 2, v / 2, n / np.linalg.norm(n), corner + (u + v) / 2
        self.place(material, {"type": "rectangle", "to_world": to_world(m)})

    def sphere(self, center, radius, material, turn=np.eye(4), medium=None):
        """Turned about its centre. Mitsuba's u is from +x over +y, its v from +z on; zrak's u from -x over +z, its v from -y on:
        so v is turned around for Mitsuba's textures."""
        m = translate(*center) @ turn
        self.objects.append({"kind": "sphere", "center": [0, 0, 0] if len(steps(turn)) else center, "radius": radius, "material": material})
        if len(steps(turn)):
            self.objects[-1]["transform"] = steps(m)
        axes = np.array([[-1, 0, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
        self.place(material, {"type": "sphere", "to_world": to_world(m @ axes @ scale(radius))}, medium, flips=True)

    def mesh_file(self, name, file):
        self.toml["meshes"].append((name, {"kind": "file", "path": f"assets/{file}"}))

    def ply(self, name, matrix):
        return {"type": "ply", "filename": str(ASSETS / f"{name}.ply"), "to_world": to_world(matrix)}

    def mesh(self, name, material, matrix=np.eye(4)):
        self.objects.append({"kind": "mesh", "mesh": name, "material": material, "transform": steps(matrix)})
        self.place(material, self.ply(name, matrix))

    # Files.

    def text(self):
        lines = [f"# {self.about}", "# Written by make.py; the picture beside it is by Mitsuba 3.9.1.", ""]
        lines += ["format = 1", f'name = "{self.name}-reference"']
        for table in ("camera", "background"):
            lines += ["", f"[{table}]"] + [f"{k} = {toml(v)}" for k, v in self.toml[table].items()]
            if table == "camera":
                lines += ["", "[render]", "samples_per_pixel = 1024", f"max_depth = {MAX_DEPTH}"]
        for table in ("textures", "materials", "media", "meshes"):
            if self.toml[table]:
                lines += ["", f"[{table}]"] + [f"{k} = {toml(v)}" for k, v in self.toml[table]]
        for light in self.lights:
            lines += ["", "[[lights]]"] + [f"{k} = {toml(v)}" for k, v in light.items()]
        for prototype, fields in self.prototypes:
            lines += ["", f"[[prototypes.{prototype}]]"] + [f"{k} = {toml(v)}" for k, v in fields.items()]
        for fields in self.objects:
            lines += ["", "[[objects]]"] + [f"{k} = {toml(v)}" for k, v in fields.items() if v != []]
        return "\n".join(lines) + "\n"


GOLD = [0.143, 0.375, 1.442], [3.983, 2.386, 1.603]
COPPER = [0.2, 0.92, 1.1], [3.9, 2.45, 2.14]


def floor(scene, color=(0.5, 0.45, 0.4), half=4.0, y=0.0):
    scene.diffuse("floor", list(color) if not isinstance(color, str) else color)
    scene.quad([-half, y, half], [2 * half, 0, 0], [0, 0, -2 * half], "floor")


def metals():
    s = Scene("metals", "Smooth, rough and directed metals under a turned sky.")
    s.camera([0, 2.6, 5.5], [0, 0.75, 0], 38)
    s.sky(rotate([0.2, 1, 0.1], 130))
    floor(s)
    s.conductor("gold", *GOLD)
    s.conductor("copper", *COPPER, alpha=(0.3, 0.3))
    s.conductor("brushed", *COPPER, alpha=(0.12, 0.5))
    r = np.array([0.8, 0.5, 0.3])
    k = 2 * np.sqrt(r / (1 - r))
    s.material("tinted", {"kind": "conductor", "metal": {"kind": "reflectance", "reflectance": r.tolist()}, "roughness": {"u": 0.04, "map": "sqrt"}},
               correlated({"type": "roughconductor", "distribution": "ggx", "alpha": 0.2, "eta": rgb([1, 1, 1]), "k": rgb(k)}, 0.2))
    s.material("mirror", {"kind": "metal", "color": [0.9, 0.8, 0.7]}, {"type": "conductor", "material": "none", "specular_reflectance": rgb([0.9, 0.8, 0.7])})
    s.image("amount", "amount.png", raw=True)
    s.conductor("patchy", *GOLD, alpha=("amount", "amount"))
    s.sphere([-1.25, 0.6, -0.6], 0.6, "gold")
    s.sphere([0, 0.6, -0.6], 0.6, "copper")
    s.sphere([1.25, 0.6, -0.6], 0.6, "brushed", turn=rotate([1, 0.5, 0.3], 60))
    s.sphere([-1.0, 0.45, 1.0], 0.45, "tinted")
    s.sphere([0, 0.45, 1.0], 0.45, "mirror")
    s.sphere([1.0, 0.45, 1.0], 0.45, "patchy", turn=rotate([0, 1, 0], 20))
    return s


def glass():
    s = Scene("glass", "Smooth, rough, thin and hollow glass under a sky.")
    s.camera([0, 2.4, 5.5], [0, 0.75, 0], 38)
    s.sky(rotate([0, 1, 0], -50))
    s.image("tiles", "tiles.png", filter="nearest", uv=[[2, 0, 0], [0, 2, 0]])
    floor(s, "tiles")
    s.dielectric("clear", 1.5)
    s.dielectric("frosted", 1.5, alpha=0.15)
    s.dielectric("rough", 1.33, alpha=0.5)
    s.dielectric("bubble", 1 / 1.5)
    s.dielectric("rough_bubble", 1 / 1.5, alpha=0.3)
    s.material("pane", {"kind": "thin_dielectric", "ior": 1.5}, {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}, twosided=False)
    s.sphere([-1.25, 0.6, -0.6], 0.6, "clear")
    s.sphere([0, 0.6, -0.6], 0.6, "frosted")
    s.sphere([1.25, 0.6, -0.6], 0.6, "rough")
    s.sphere([-0.9, 0.5, 0.9], 0.5, "clear")
    s.sphere([-0.9, 0.5, 0.9], 0.4, "bubble")
    s.sphere([0.25, 0.45, 0.9], 0.45, "clear")
    s.sphere([0.25, 0.45, 0.9], 0.33, "rough_bubble")
    s.quad([0.9, 0.05, 1.3], [0.7, 0, -0.5], [0.1, 1.0, 0], "pane")
    return s


def textures():
    s = Scene("textures", "Filters, wrap modes and coordinates of textures, seen in parallel lines; a picture that shines.")
    s.camera([0, 0, 5], [0, 0, 0], height=4.2)
    s.constant([1, 1, 1])
    far = [[2.3, 0.4, -0.7], [-0.3, 2.1, -0.4]]
    i = 0
    for filter in ("nearest", "bilinear"):
        for wrap in ("repeat", "mirror", "clamp"):
            name = s.image(f"{filter}_{wrap}", "tiles.png", filter=filter, wrap=wrap, uv=far)
            s.diffuse(f"quad{i}", name)
            s.quad([-2 + 1.35 * (i % 3), 0.7 - 1.35 * (i // 3), 0], [1.25, 0, 0], [0, 1.25, 0], f"quad{i}")
            i += 1
    s.image("plain", "tiles.png", filter="nearest")
    s.diffuse("plain", "plain")
    s.sphere([-1.35, -1.4, 0], 0.6, "plain", turn=rotate([1, 0.3, -0.4], 35))
    # A cylinder that stands askew.
    m = translate(0, -1.35, 0) @ rotate([1, 0.2, 0.1], 60) @ translate(0, 0, -0.5)
    s.objects.append({"kind": "cylinder", "radius": 0.4, "z_min": 0, "z_max": 1, "material": "plain", "transform": steps(m)})
    s.place("plain", {"type": "cylinder", "p0": [0, 0, 0], "p1": [0, 0, 1], "radius": 0.4, "to_world": to_world(m)})
    # A picture that shines, scaled, behind a rim of it.
    s.image("shine", "tiles.png", uv=[[1, 0, 0], [0, 1, 0]])
    s.lamp("lamp", "shine")
    s.quad([0.75, -1.95, 0], [1.2, 0.1, 0.2], [0, 1.1, 0], "lamp")
    return s


def bumps():
    s = Scene("bumps", "Normal maps, bump maps and normals of meshes, under a sky and a lamp.")
    s.camera([0, 3.4, 3.6], [0, 0.05, 0.1], 42)
    s.sky(rotate([0, 1, 0], 60), 0.7)
    s.image("tiles", "tiles.png")
    s.image("normals", "normals.png", raw=True)
    s.image("heights", "heights.pfm", raw=True)
    s.mesh_file("hills", "hills.ply")
    s.diffuse("white", [0.8, 0.8, 0.8])
    s.diffuse("tiles", "tiles")
    s.conductor("copper", *COPPER, alpha=(0.25, 0.25))

    def mapped(name, base):
        inner = {"type": "normalmap", "normalmap": s.textures["normals"], "bsdf": s.bsdfs[base]["bsdf"], "flip_invalid_normals": False, "use_shadowing_function": False}
        return s.surface(name, base, {"type": "twosided", "bsdf": inner}, normal_map="normals")

    mapped("mapped", "white")
    mapped("mapped_copper", "copper")
    inner = {"type": "bumpmap", "arbitrary": s.textures["heights"], "scale": 4.0, "bsdf": s.bsdfs["white"]["bsdf"], "flip_invalid_normals": False, "use_shadowing_function": False}
    s.toml["textures"].append(("higher", {"kind": "multiply", "a": "heights", "b": [4, 4, 4]}))
    s.surface("bumpy", "white", {"type": "twosided", "bsdf": inner}, bump="higher")
    s.quad([-1.5, 0, -0.1], [1.4, 0, 0], [0, 0, -1.4], "mapped")
    s.quad([0.1, 0, -0.1], [1.4, 0, 0], [0, 0, -1.4], "bumpy")
    s.quad([0.1, 0, 1.5], [1.4, 0, 0], [0, 0, -1.4], "mapped_copper")
    s.mesh("hills", "tiles", translate(-0.8, 0, 0.8) @ rotate([1, 0, 0], -90) @ scale(0.7))
    s.lamp("lamp", [6, 5, 4])
    s.quad([-2.6, 0.1, -1.6], [0, 1.3, 0], [0, 0, 3.2], "lamp")
    return s


def holes():
    s = Scene("holes", "Alpha, mixtures, leaves and one-sided lamps.")
    s.camera([0, 1.6, 5.2], [0, 0.9, 0], 38)
    s.sky(rotate([0, 1, 0], 200))
    floor(s)
    s.image("amount", "amount.png", raw=True)
    s.image("stencil", "amount.png", filter="nearest", raw=True)
    s.diffuse("red", [0.7, 0.2, 0.15])
    s.diffuse("blue", [0.2, 0.3, 0.7])
    s.conductor("gold", *GOLD, alpha=(0.3, 0.3))
    s.surface("veil", "red", {"type": "mask", "opacity": 0.6, "bsdf": s.bsdfs["red"]}, alpha=0.6)
    s.surface("lace", "blue", {"type": "mask", "opacity": s.textures["amount"], "bsdf": s.bsdfs["blue"]}, alpha="amount")
    cut = dict(s.textures["stencil"])
    cut["bitmap"] = mi.Bitmap((np.array(mi.Bitmap(str(ASSETS / "amount.png"))).reshape(8, 8, 1) >= 128).astype(np.float32))
    s.surface("grid", "gold", {"type": "mask", "opacity": cut, "bsdf": s.bsdfs["gold"]}, alpha="stencil", alpha_cutoff=0.5)
    blend = {"type": "blendbsdf", "weight": s.textures["amount"], "bsdf_0": s.bsdfs["red"], "bsdf_1": s.bsdfs["gold"]}
    s.material("patchy", {"kind": "mix", "materials": ["red", "gold"], "amount": "amount"}, blend, twosided=False)
    leaf = {"type": "diffusetransmission", "reflectance": rgb([0.2, 0.35, 0.1]), "transmittance": rgb([0.3, 0.45, 0.1])}
    s.material("leaf", {"kind": "diffuse_transmission", "reflectance": [0.2, 0.35, 0.1], "transmittance": [0.3, 0.45, 0.1]}, leaf, twosided=False)
    s.lamp("lamp", [3, 2.6, 2])
    s.sphere([-1.3, 0.5, 0], 0.5, "patchy", turn=rotate([1, 1, 0], 50))
    s.quad([-0.65, 0, 0.9], [0.7, 0, 0.1], [0, 0.9, 0], "veil")
    s.quad([0.15, 0, 0.9], [0.7, 0, -0.1], [0, 0.9, 0], "lace")
    s.quad([0.95, 0, 0.7], [0.7, 0, -0.3], [0, 0.9, 0], "grid")
    s.quad([-0.7, 0.1, -0.6], [0.9, 0, 0.2], [0, 1.5, -0.3], "leaf")
    s.sphere([0.95, 1.15, -0.6], 0.5, "veil")
    # Two lamps back to back would be the same as one that shines on both sides; these are single.
    s.quad([-1.8, 1.3, -1.2], [0.9, 0, 0], [0, 0.7, 0], "lamp")
    s.quad([0.5, 1.9, 0.3], [-0.9, 0, 0], [0, 0.5, 0], "lamp")
    return s


def media():
    s = Scene("media", "Fog with a phase function in nothing, in glass and in a box; under a sky.")
    s.camera([0, 1.8, 5.2], [0, 0.75, 0], 36)
    s.sky(rotate([0, 1, 0], 20))
    floor(s)
    s.mitsuba["integrator"]["type"] = "volpathmis"

    def medium(name, sigma_a, sigma_s, g):
        s.toml["media"].append((name, {"sigma_a": sigma_a, "sigma_s": sigma_s, "g": g}))
        a, b = np.array(sigma_a), np.array(sigma_s)
        # Numbers above 1 are not let through as colours.
        most = float((a + b).max())
        s.media[name] = {"type": "homogeneous", "sigma_t": rgb((a + b) / most), "scale": most, "albedo": rgb(b / (a + b)), "phase": {"type": "hg", "g": g}}

    medium("fog", [0.1, 0.2, 0.4], [2.0, 1.6, 1.2], 0.6)
    medium("ink", [0.4, 1.5, 2.5], [0.5, 0.4, 0.3], -0.4)
    medium("milk", [0.02, 0.03, 0.05], [3, 3, 3], 0.0)
    s.toml["materials"].append(("nothing", {"kind": "interface"}))
    s.surface("shell", "nothing", {"type": "null"}, medium={"inside": "fog"})
    s.dielectric("clear", 1.4)
    s.surface("glass", "clear", s.bsdfs["clear"], medium={"inside": "ink"})
    s.sphere([-1.1, 0.75, 0], 0.75, "shell", medium="fog")
    s.sphere([0.55, 0.7, 0.3], 0.6, "glass", medium="ink")
    # The other kind of medium, of constant density inside a turned box.
    s.toml["materials"].append(("smoke", {"kind": "isotropic", "color": [0.9, 0.8, 0.6]}))
    m = translate(1.3, 0.75, -1.1) @ rotate([0.2, 1, 0], 30)
    s.objects.append({"kind": "medium", "boundary": {"kind": "box", "min": [-0.5, -0.5, -0.5], "max": [0.5, 0.5, 0.5]}, "density": 2, "material": "smoke", "transform": steps(m)})
    smoke = {"type": "homogeneous", "sigma_t": 2.0, "albedo": rgb([0.9, 0.8, 0.6]), "phase": {"type": "isotropic"}}
    s.mitsuba["smoke"] = {"type": "cube", "to_world": to_world(m @ scale(0.5)), "bsdf": {"type": "null"}, "interior": smoke}
    return s


def lamps():
    s = Scene("lamps", "A point light, a spot and distant light on matte, rough and mapped surfaces.")
    s.camera([0, 2.6, 4.8], [0, 0.4, 0], 40)
    s.constant([0.02, 0.02, 0.03])
    floor(s)
    s.diffuse("red", [0.7, 0.2, 0.15])
    s.conductor("copper", *COPPER, alpha=(0.35, 0.35))
    s.dielectric("frosted", 1.5, alpha=0.4)
    s.sphere([-1.1, 0.5, 0], 0.5, "copper")
    s.sphere([0.1, 0.5, 0.3], 0.5, "frosted")
    s.mesh_file("hills", "hills.ply")
    s.mesh("hills", "red", translate(1.2, 0.35, 0) @ rotate([1, 0, 0], -70) @ scale(0.6))
    s.lights.append({"kind": "point", "position": [-0.6, 2.2, 1.2], "intensity": [3, 4, 5]})
    s.mitsuba["point"] = {"type": "point", "position": [-0.6, 2.2, 1.2], "intensity": rgb([3, 4, 5])}
    s.lights.append({"kind": "distant", "direction": [1, -1.5, -0.7], "irradiance": [0.9, 0.8, 0.5]})
    s.mitsuba["sun"] = {"type": "directional", "direction": [1, -1.5, -0.7], "irradiance": rgb([0.9, 0.8, 0.5])}
    # With a rim that is all but sharp: the curves of the falloff differ.
    origin, target = np.array([2.0, 3.0, 1.5]), np.array([0.7, 0, 0.2])
    s.lights.append({"kind": "spot", "position": origin, "direction": target - origin, "intensity": [14, 10, 6], "cone_angle_deg": 17, "falloff_start_deg": 16.999})
    s.mitsuba["spot"] = {"type": "spot", "to_world": T4().look_at(origin=origin.tolist(), target=target.tolist(), up=[0, 1, 0]), "intensity": rgb([14, 10, 6]), "cutoff_angle": 17.0, "beam_width": 16.999}
    return s


def instances():
    s = Scene("instances", "Nested instances, stretched and mirrored; rings and cylinders; through a thin lens.")
    s.camera([0, 2.2, 5], [0, 0.6, 0], 38, lens=(0.12, 5.2))
    s.sky(rotate([0, 1, 0], -120))
    floor(s)
    s.image("tiles", "tiles.png")
    s.diffuse("tiles", "tiles")
    s.dielectric("frosted", 1.5, alpha=0.2)
    s.conductor("copper", *COPPER, alpha=(0.15, 0.4))
    s.mesh_file("hills", "hills.ply")
    # Mitsuba's instances cannot be nested: the maps are multiplied here.
    up = rotate([1, 0, 0], -90)
    inner = translate(0, 0.9, 0) @ scale(0.5, 0.8, 0.5)
    s.prototypes = [
        ("thing", {"kind": "mesh", "mesh": "hills", "material": "tiles", "transform": steps(up)}),
        ("thing", {"kind": "sphere", "center": [0, 0.45, 0], "radius": 0.35, "material": "frosted"}),
        ("pair", {"kind": "instance", "prototype": "thing"}),
        ("pair", {"kind": "instance", "prototype": "thing", "transform": steps(inner)}),
    ]
    s.mitsuba["thing"] = {
        "type": "shapegroup",
        "mesh": {**s.ply("hills", up), "bsdf": s.bsdfs["tiles"]},
        "ball": {"type": "sphere", "center": [0, 0.45, 0], "radius": 0.35, "bsdf": s.bsdfs["frosted"]},
    }
    places = [
        translate(-1.1, 0.15, 0) @ rotate([0, 1, 0], 25) @ scale(0.6),
        translate(0.4, 0.15, -0.3) @ rotate([0, 1, 0.2], -35) @ scale(0.7, 0.5, 0.5),
        translate(1.4, 0.15, 0.8) @ scale(-0.5, 0.5, 0.5) @ rotate([0, 1, 0], 40),
    ]
    for m in places:
        s.objects.append({"kind": "instance", "prototype": "pair", "transform": steps(m)})
        for part in (m, m @ inner):
            s.mitsuba[f"instance{len(s.mitsuba)}"] = {"type": "instance", "to_world": to_world(part), "thing": {"type": "ref", "id": "thing"}}
    # An ellipse; a disk, on which u is along the rim in zrak and across it in Mitsuba; and a cylinder.
    s.conductor("gold", *GOLD, alpha=(0.2, 0.2))
    m = translate(-0.3, 0.5, 1.3) @ rotate([0.1, 1, 0], 30) @ scale(0.35, 0.5, 1)
    s.objects.append({"kind": "disk", "radius": 1, "material": "gold", "transform": steps(m)})
    s.place("gold", {"type": "disk", "to_world": to_world(m)})
    m = translate(-1.1, 0.4, 1.6) @ rotate([0.2, 1, 0], -40) @ scale(0.4)
    s.objects.append({"kind": "disk", "radius": 1, "material": "copper", "transform": steps(m)})
    s.conductor("turned", *COPPER, alpha=(0.4, 0.15))
    s.place("turned", {"type": "disk", "to_world": to_world(m)})
    s.toml["materials"].pop()
    m = translate(0.9, 0.2, 1.4) @ rotate([0, 1, 0], 60)
    s.objects.append({"kind": "cylinder", "radius": 0.2, "z_min": -0.4, "z_max": 0.4, "material": "copper", "transform": steps(m)})
    s.place("copper", {"type": "cylinder", "p0": [0, 0, -0.4], "p1": [0, 0, 0.4], "radius": 0.2, "to_world": to_world(m)})
    return s


def layers():
    s = Scene("layers", "The principled surface where it is a simpler one, and a coated one that has a closed form.")
    s.camera([0, 2.4, 5.5], [0, 0.75, 0], 38)
    s.sky(rotate([0, 1, 0], 80))
    s.image("tiles", "tiles.png")
    floor(s, "tiles")

    def principled(name, bsdf, twosided=True, **surface):
        return s.material(name, {"kind": "principled", "surface": surface}, bsdf, twosided)

    principled("matte", {"type": "diffuse", "reflectance": rgb([0.6, 0.3, 0.2])}, base_color=[0.6, 0.3, 0.2], specular_weight=0)
    # Not so rough that it would matter that zrak's metal gets back what its facets lose.
    metal = {"type": "principled", "base_color": rgb([0.9, 0.6, 0.3]), "metallic": 1.0, "roughness": 0.25}
    principled("metal", correlated(metal, 0.0625), base_color=[0.9, 0.6, 0.3], base_metalness=1, specular_roughness=0.25)
    glass = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    principled("glass", glass, twosided=False, transmission_weight=1, specular_roughness=0)
    rough = {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.04, "int_ior": 1.5, "ext_ior": 1.0}
    principled("frosted", correlated(rough, 0.04), twosided=False, transmission_weight=1, specular_roughness=0.2)
    plastic = {"type": "plastic", "diffuse_reflectance": rgb([0.2, 0.5, 0.7]), "int_ior": 1.5, "ext_ior": 1.0, "nonlinear": True}
    coat = {"thickness": 1e-6, "max_depth": 200}
    s.material("plastic", {"kind": "coated_diffuse", "color": [0.2, 0.5, 0.7], "coat": coat}, plastic)
    pane = {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}
    principled("pane", pane, twosided=False, transmission_weight=1, specular_roughness=0, geometry_thin_walled=True)
    s.sphere([-1.25, 0.6, -0.6], 0.6, "matte")
    s.sphere([0, 0.6, -0.6], 0.6, "metal")
    s.sphere([1.25, 0.6, -0.6], 0.6, "glass")
    s.sphere([-0.9, 0.45, 0.9], 0.45, "frosted")
    s.sphere([0.15, 0.45, 0.9], 0.45, "plastic")
    s.quad([0.8, 0.05, 1.3], [0.7, 0, -0.5], [0.1, 1.0, 0], "pane")
    return s


SCENES = {f.__name__: f for f in (metals, glass, textures, bumps, holes, media, lamps, instances, layers)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=list(SCENES))
    parser.add_argument("--passes", type=int, default=32)
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--scenes-only", action="store_true", help="write the scenes without rendering them")
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    if args.threads:
        dr.set_thread_count(args.threads)
    make_assets()
    for name in args.names:
        described = SCENES[name]()
        (HERE / f"{name}.toml").write_text(described.text())
        if args.scenes_only:
            continue
        scene = mi.load_dict(described.mitsuba)
        passes = np.stack([np.array(mi.render(scene, spp=args.spp, seed=1000 + i), np.float64) for i in range(args.passes)])
        mean, error = passes.mean(0), passes.std(0, ddof=1) / np.sqrt(args.passes)
        np.save(HERE / f"{name}.npy", mean.astype(np.float32))
        np.save(HERE / f"{name}_stderr.npy", error.astype(np.float32))
        print(f"{name}: mean {mean.mean((0, 1)).round(4)}, median relative error {np.median(error / (mean + 1e-3)):.1e}", flush=True)


if __name__ == "__main__":
    main()
