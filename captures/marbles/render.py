"""Renders the capture `marbles`: the update, its depth and motion, and the truth.

    python render.py OUT            with the `bpy` package (Python 3.11: pip install bpy==5.0.1)
    blender -b -P render.py -- OUT  with Blender itself

`capture.toml` beside this script says which frames there are and what their files are called;
OUT receives all of them and a copy of `capture.toml`, so it is a complete capture afterwards.

Two renders make the update. The picture has 32 samples a pixel and Blender's usual pixel filter,
because an aliased picture warps badly. Depth and motion come from one sample through the centre of
each pixel, because Blender averages the vector pass over the pixel: with more samples, a pixel at
the edge of a moving object would carry a velocity that belongs to neither side.

There is no noise to clean up and nothing random: one hard sun, no bounces, a constant ambient
glow, a fixed seed. Time is in frames, lengths are in units of one table tile, z is up.
"""

import math
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

try:
    import bpy
    from mathutils import Quaternion, Vector
except ImportError:
    sys.exit(
        "render.py: the module `bpy` is missing: install it into Python 3.11 with "
        '`pip install bpy==5.0.1 "numpy<2"`, or run `blender -b -P render.py -- OUT`'
    )

HERE = Path(__file__).resolve().parent
BLENDER = (5, 0, 1)
SIZE = (192, 144)
LENS_MM, SENSOR_MM = 42.0, 36.0
SAMPLES = 32
AMBIENT = 0.42  # share of a surface's colour that is seen without the sun
SUN = 2.3  # W/m^2; a white surface facing the sun has the radiance SUN / pi + AMBIENT


# --- Materials -----------------------------------------------------------------------------------


class Nodes:
    """A material's node tree, written down from the texture to the surface."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        # The glow is looked at, it lights nothing: sampling it as a lamp would bring noise.
        self.material.cycles.emission_sampling = "NONE"
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.place = self.add("ShaderNodeTexCoord").outputs["Object"]

    def add(self, kind, inputs=None, **settings):
        """Adds a node; an input is a value or the output of another node."""
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def ramp(self, value, *stops, steps=False):
        """Colours a value: stops are (position, colour)."""
        node = self.add("ShaderNodeValToRGB", {0: value})
        ramp = node.color_ramp
        ramp.interpolation = "CONSTANT" if steps else "LINEAR"
        while len(ramp.elements) < len(stops):
            ramp.elements.new(1.0)
        for element, (position, color) in zip(ramp.elements, stops):
            element.position, element.color = position, rgba(color)
        return node.outputs["Color"]

    def wave(self, **inputs):
        """Value of stripes across x, bent by noise as `Distortion` says."""
        inputs = {key.replace("_", " "): value for key, value in inputs.items()}
        return self.add("ShaderNodeTexWave", {"Vector": self.place, **inputs}).outputs["Fac"]

    def speckle(self, color, scale, low=0.75, high=1.1):
        """Multiplies a colour by smooth noise between about `low` and `high`."""
        noise = self.add("ShaderNodeTexNoise", {"Vector": self.place, "Scale": scale, "Detail": 1.0})
        gain = self.add(
            "ShaderNodeMapRange",
            {"Value": noise.outputs[0], "From Min": 0.3, "From Max": 0.7, "To Min": low, "To Max": high},
        )
        return self.add("ShaderNodeVectorMath", {0: color, 1: gain.outputs[0]}, operation="MULTIPLY").outputs[0]

    def finish(self, color, polish=0.0):
        """Ends in a surface that glows faintly, scatters the sun and, polished, mirrors it too."""
        glow = self.add("ShaderNodeEmission", {"Color": color, "Strength": AMBIENT})
        matt = self.add("ShaderNodeBsdfDiffuse", {"Color": color})
        surface = self.add("ShaderNodeAddShader", {0: glow.outputs[0], 1: matt.outputs[0]})
        if polish:
            white = self.add("ShaderNodeBsdfAnisotropic", {"Color": (polish, polish, polish, 1), "Roughness": 0.3})
            surface = self.add("ShaderNodeAddShader", {0: surface.outputs[0], 1: white.outputs[0]})
        self.add("ShaderNodeOutputMaterial", {"Surface": surface.outputs[0]})
        return self.material


def rgba(color):
    """Linear colour with alpha from an sRGB hexadecimal such as "c8102e"."""
    srgb = [int(color[i : i + 2], 16) / 255 for i in (0, 2, 4)]
    return tuple(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in srgb) + (1.0,)


def checkered(light, dark):
    m = Nodes("checkered")
    tiles = m.add(
        "ShaderNodeTexChecker", {"Vector": m.place, "Color1": rgba(light), "Color2": rgba(dark), "Scale": 1.0}
    )
    return m.finish(m.speckle(tiles.outputs["Color"], 2.3, 0.84, 1.08))


def swirled(name, scale, distortion, *stops):
    """Ribbons of colour in glass."""
    m = Nodes(name)
    return m.finish(m.ramp(m.wave(Scale=scale, Distortion=distortion, Detail=1.0, Detail_Scale=1.2), *stops), 0.12)


def striped(name, light, dark, scale):
    m = Nodes(name)
    return m.finish(m.ramp(m.wave(Scale=scale), (0.0, dark), (0.5, light), steps=True), 0.1)


def spotted(name, ground, spot, scale):
    m = Nodes(name)
    cells = m.add("ShaderNodeTexVoronoi", {"Vector": m.place, "Scale": scale, "Randomness": 0.5})
    return m.finish(m.ramp(cells.outputs["Distance"], (0.0, spot), (0.42, ground), steps=True), 0.12)


def wooden(name, light, dark):
    m = Nodes(name)
    rings = m.wave(Scale=1.1, Distortion=5.0, Detail=1.0, Detail_Scale=1.0)
    return m.finish(m.ramp(rings, (0.1, dark), (0.8, light)))


def plain(name, color):
    m = Nodes(name)
    return m.finish(m.speckle(rgba(color)[:3], 3.0))


# --- Bodies --------------------------------------------------------------------------------------


def ball(name, radius, material, at=(0, 0, 0)):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, segments=96, ring_count=48, location=at)
    return dress(name, material, smooth=True)


def block(name, size, material, at=(0, 0, 0), turn=0.0):
    """A box standing on `at`; turned by `turn` radians about the vertical. Its origin is its foot."""
    bpy.ops.mesh.primitive_cube_add(size=1.0)
    body = dress(name, material)
    for vertex in body.data.vertices:
        vertex.co = Vector((vertex.co.x * size[0], vertex.co.y * size[1], (vertex.co.z + 0.5) * size[2]))
    body.location, body.rotation_euler = at, (0.0, 0.0, turn)
    return body


def dress(name, material, smooth=False):
    body = bpy.context.object
    body.name = name
    body.data.materials.append(material)
    if smooth:
        bpy.ops.object.shade_smooth()
    return body


def move(body, pose, last):
    """Keys `pose(t) -> (place, turn)` at every frame from one before the update to one after the end.

    The vector pass of a frame looks one frame back and one ahead; nothing lies between the keys.
    """
    body.rotation_mode = "QUATERNION"
    for t in range(-1, last + 2):
        body.location, body.rotation_quaternion = pose(t)
        body.keyframe_insert("location", frame=t)
        body.keyframe_insert("rotation_quaternion", frame=t)


def rolling(start, heading, radius, speed, gain):
    """Rolls on the table without slipping: `speed` in units a frame, growing by `gain` each frame."""
    heading = Vector(heading).normalized()
    axle = Vector((0, 0, 1)).cross(heading)

    def pose(t):
        way = speed * t + gain * t * t / 2
        return Vector(start) + way * heading + Vector((0, 0, radius)), Quaternion(axle, way / radius)

    return pose


def thrown(start, velocity, gravity, axle, spin):
    """Flies on a parabola and spins evenly about `axle`; `gravity` in units a frame, each frame."""
    def pose(t):
        place = Vector(start) + t * Vector(velocity) + t * t / 2 * Vector((0, 0, -gravity))
        return place, Quaternion(axle, spin * t)

    return pose


def tipping(hinge, angle, speed, gain):
    """Turns about the axis x through `hinge`, backwards, ever faster; radians."""
    return lambda t: (Vector(hinge), Quaternion((1, 0, 0), -(angle + speed * t + gain * t * t / 2)))


# --- Scene ---------------------------------------------------------------------------------------


def build(last):
    plane = bpy.ops.mesh.primitive_plane_add
    plane(size=40.0, location=(0.5, 0.5, 0.0))
    dress("table", checkered("e9d8b4", "a8623a"))
    plane(size=40.0, location=(0.0, 4.2, 0.0), rotation=(math.pi / 2, 0.0, 0.0))
    wall = Nodes("wall")
    hills = wall.wave(Scale=0.16, Distortion=3.0, Detail=1.0, Detail_Scale=0.5)
    dress("wall", wall.finish(wall.speckle(wall.ramp(hills, (0.1, "3c6e82"), (0.9, "8fbcb4")), 1.4, 0.86, 1.08)))

    # Still: what the camera's own motion covers and uncovers.
    oak = wooden("oak", "d9a866", "8a5426")
    block("brick", (1.5, 0.8, 0.8), oak, (1.15, 1.0, 0.0), 0.3)
    block("cube", (0.8, 0.8, 0.8), plain("blue", "2f5fa8"), (1.0, 1.05, 0.8), -0.15)
    block("post", (0.5, 0.5, 1.7), wooden("beech", "f0d9a8", "c48a4a"), (-2.6, 2.2, 0.0), 0.5)
    ball("emerald", 0.34, swirled("emerald", 1.0, 3.0, (0.1, "0d5c3a"), (0.9, "9fe0a0")), (2.5, -0.5, 0.34))

    # Moving: slowing down, speeding up, falling, tipping.
    azure = ball("azure", 0.62, swirled("azure", 0.5, 4.0, (0.05, "123a8c"), (0.5, "4fb0e8"), (0.95, "f4f8ff")))
    move(azure, rolling((-1.55, -0.7, 0.0), (1.0, -0.25, 0.0), 0.62, 0.038, -0.0012), last)
    ruby = ball("ruby", 0.5, spotted("ruby", "b3122a", "ffe9c9", 1.4))
    move(ruby, rolling((2.9, 2.5, 0.0), (-1.0, 0.05, 0.0), 0.5, 0.024, 0.001), last)
    gold = ball("gold", 0.42, striped("gold", "ffd23f", "d9480f", 0.75))
    move(gold, thrown((-2.3, 0.6, 1.75), (0.19, 0.0, 0.085), 0.0125, (0.0, 1.0, 0.0), 0.03), last)
    domino(last)

    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = SUN, 0.0
    lamp = bpy.data.objects.new("sun", sun)
    lamp.rotation_euler = Vector((0.45, 0.6, -1.0)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(lamp)
    bpy.context.scene.world = bpy.data.worlds.new("dark")
    bpy.context.scene.world.color = (0, 0, 0)
    camera(last)


def domino(last):
    """A tile with five pips, seen from the front, that falls away from the camera."""
    body = block("domino", (0.75, 0.2, 1.35), plain("ivory", "f3ead2"))
    for vertex in body.data.vertices:
        vertex.co.y -= 0.1  # the origin becomes the edge that it tips over
    ink = plain("ink", "22222a")
    for x, z in ((-0.2, 0.3), (0.2, 0.3), (0.0, 0.67), (-0.2, 1.04), (0.2, 1.04)):
        bpy.ops.mesh.primitive_cylinder_add(
            vertices=48, radius=0.1, depth=0.02, location=(x, -0.2, z), rotation=(math.pi / 2, 0, 0)
        )
        dress("pip", ink).parent = body
    move(body, tipping((-0.45, 1.1, 0.0), 0.25, 0.022, 0.0012), last)


def camera(last):
    eye = bpy.data.cameras.new("eye")
    eye.lens, eye.sensor_width = LENS_MM, SENSOR_MM
    body = bpy.data.objects.new("eye", eye)
    bpy.context.collection.objects.link(body)
    bpy.context.scene.camera = body

    def pose(t):
        place = Vector((-0.75 + 0.055 * t, -7.4 + 0.01 * t, 3.1))
        aim = Vector((0.0 + 0.022 * t, 0.6, 0.75))
        return place, (aim - place).to_track_quat("-Z", "Y")

    move(body, pose, last)


# --- Pictures ------------------------------------------------------------------------------------


def settings():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.use_motion_blur = False  # the vector pass stays empty with it
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.view_settings.view_transform = "Standard"
    scene.render.dither_intensity = 0.0  # else noise in the last bit
    scene.cycles.device = "CPU"
    scene.cycles.seed = 0
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0
    for flag in dir(scene.render):
        if flag.startswith("use_stamp_"):  # neither dates nor machine names in the files
            setattr(scene.render, flag, False)


def render(frame, file, samples, filter_kind, filter_width):
    scene = bpy.context.scene
    scene.frame_set(frame)
    scene.cycles.samples = samples
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = filter_kind, filter_width
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)


def render_color(frame, file):
    """The picture as sRGB PNG; `optipng`, where there is one, makes the file smaller, not the picture."""
    form = bpy.context.scene.render.image_settings
    form.media_type, form.file_format = "IMAGE", "PNG"
    form.color_mode, form.color_depth, form.compression = "RGB", "8", 100
    render(frame, file, SAMPLES, "BLACKMAN_HARRIS", 1.5)
    if shutil.which("optipng"):
        subprocess.run(["optipng", "-quiet", "-o7", "-strip", "all", str(file)], check=True)


def render_data(frame, file):
    """Depth and motion at the pixels' centres, in one EXR file with a part for each pass."""
    form = bpy.context.scene.render.image_settings
    form.media_type, form.file_format = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER"
    form.color_depth, form.exr_codec = "16", "ZIP"  # 16 bits for colour only: depth and motion keep 32
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_vector = True
    # Blender writes the picture too, asked or not; a black one takes no room.
    layer.material_override = Nodes("black").finish((0.0, 0.0, 0.0, 1.0))
    render(frame, file, 1, "BOX", 0.01)
    layer.material_override = None
    layer.use_pass_z = layer.use_pass_vector = False


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    if len(arguments) != 1 or arguments[0].startswith("-"):
        sys.exit("usage: python render.py OUT, or blender -b -P render.py -- OUT")
    out = Path(arguments[0]).resolve()
    manifest = tomllib.loads((HERE / "capture.toml").read_text(encoding="utf-8"))
    update, truth = manifest["update"], manifest["truth"]
    if bpy.app.version != BLENDER:
        print(f"render.py: made for Blender {BLENDER}, this is {bpy.app.version}: pixels may differ", file=sys.stderr)

    bpy.ops.wm.read_factory_settings(use_empty=True)
    build(manifest["frames"])
    settings()
    render_data(0, out / update["motion"]["file"])
    render_color(0, out / update["color"])
    for entry in truth:
        render_color(entry["frame"], out / entry["color"])
    if out != HERE:
        shutil.copy(HERE / "capture.toml", out)


if __name__ == "__main__":
    main()
