"""Changes a glTF file but keeps most of it valid: numbers, types, indices, counts, strides, cycles, missing and duplicate
members, extensions, strings, data and the container. Each function takes a random.Random and a Model and changes the model."""
import base64
import copy
import json
import struct

STRANGE_NUMBERS = [0, 1, 2, 3, 4, 7, 8, 12, 16, 17, 240, 255, 256, 1023, 1024, 65535, 65536, 1 << 24, (1 << 31) - 1, 1 << 31,
                   (1 << 32) - 1, 1 << 32, (1 << 33) + 1, (1 << 53) + 1, (1 << 63) - 1, 1 << 64, -1, -2, -4, -(1 << 31), -(1 << 63),
                   0.5, 1.5, -0.0, 1e-40, 1e-30, 1e18, 2e18, 1e19, 1e25, 3e38, 1e39, -3e38, 1e300, 5120, 5121, 5122, 5123, 5125, 5126,
                   5131]
STRANGE_STRINGS = ["", ".", "..", "/", "%00", "\x00", "a\nb", "a\rb", "\x1b[31mred\x1b[0m", "\x9b31m", "\x07", "\u202ertl", "\ud800", "é" * 300,
                   "x" * 5000, "../../../../etc/hostname", "/etc/hostname", "file:///etc/hostname", "http://localhost/x.bin", "gone.bin",
                   "data:application/octet-stream;base64,AAAA", "data:image/png;base64,AAAA", "data:", "SCALAR", "VEC3", "MAT4", "%s%n",
                   "2.0", "1.0", "TRIANGLES", "QUATERNION", "vertices", "texels", "probes", "raw", "clustered"]
STRANGE_FLOATS = [b"\x00\x00\xc0\x7f", b"\x00\x00\x80\x7f", b"\x00\x00\x80\xff", b"\xff\xff\x7f\x7f", b"\xff\xff\x7f\xff",
                  b"\x01\x00\x00\x00", b"\x00\x00\x00\x80", b"\xff\xff\xff\xff", struct.pack("<f", 2e18), struct.pack("<f", 1e25)]
INDICES = {"accessor", "buffer", "bufferView", "camera", "index", "indices", "input", "joint", "material", "mesh", "node", "output",
           "sampler", "scene", "skeleton", "skin", "source", "images", "map", "texCoord", "firstVertex", "TEXCOORD_1", "inverseBindMatrices", "POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0",
           "JOINTS_0", "WEIGHTS_0", "_PRT_CLUSTER", "_PRT_WEIGHTS_0", "_PRT_WEIGHTS_1"}
SIZES = {"count", "byteLength", "byteOffset", "byteStride", "clusterBits", "order", "channels", "components", "componentType", "target", "width",
         "height"}
EXTENSIONS = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing", "KHR_materials_volume",
              "KHR_texture_transform", "KHR_mesh_quantization", "KHR_node_visibility", "PRTKIT_transfer",
              "PRTKIT_instances", "PRTKIT_lobes", "EXT_unheard_of"]


class Model:
    """A parsed .glb; `text`, if set, replaces the JSON written from `json`."""

    def __init__(self, data):
        length, = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20:20 + length])
        self.binary = bytearray(data[20 + length + 8:])
        self.text = None
        self.container = lambda whole: whole

    def to_bytes(self):
        text = (self.text or json.dumps(self.json, ensure_ascii=False)).encode("utf-8", "surrogatepass")
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if binary:
            chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return self.container(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)


def members(value, path=()):
    """Yields every member below `value`: its container, its key, and the last name of its path."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in items:
        name = key if isinstance(key, str) else path
        yield value, key, name
        yield from members(member, name)


def chosen(random, model, wanted=lambda member, name: True):
    """Returns a random member among those `wanted`, or None."""
    found = [slot for slot in members(model.json) if wanted(slot[0][slot[1]], slot[2])]
    return random.choice(found) if found else None


def is_number(member, _=None):
    return isinstance(member, (int, float)) and not isinstance(member, bool)


def change_number(random, model):
    slot = chosen(random, model, is_number)
    if slot:
        holder, key, _ = slot
        old = holder[key]
        holder[key] = random.choice([old + 1, old - 1, -old, 2 * old, old / 2, old + 0.5, random.choice(STRANGE_NUMBERS)])


def change_size(random, model):
    slot = chosen(random, model, lambda member, name: is_number(member) and name in SIZES)
    if slot:
        holder, key, _ = slot
        holder[key] = random.choice([holder[key] + random.choice([-4, -3, -1, 1, 3, 4]), 0, -1, 1, holder[key] * 1000,
                                     random.choice(STRANGE_NUMBERS)])


def change_index(random, model):
    slot = chosen(random, model, lambda member, name: is_number(member) and name in INDICES)
    if slot:
        slot[0][slot[1]] = random.choice([random.randrange(12), -1, 1 << 31])


def change_type(random, model):
    slot = chosen(random, model)
    if slot:
        slot[0][slot[1]] = random.choice([None, True, False, 0, 1.5, "", "text", [], {}, [[]], [{}], {"a": 1}, [0] * 20])


def change_string(random, model):
    slot = chosen(random, model, lambda member, name: isinstance(member, str))
    if slot:
        slot[0][slot[1]] = random.choice(STRANGE_STRINGS)


def add_name(random, model):
    slot = chosen(random, model, lambda member, name: isinstance(member, dict))
    if slot:
        slot[0][slot[1]][random.choice(["name", "uri", "mimeType"])] = random.choice(STRANGE_STRINGS)


def delete_member(random, model):
    slot = chosen(random, model)
    if slot:
        del slot[0][slot[1]]


def double_member(random, model):
    slot = chosen(random, model, lambda member, name: isinstance(member, list))
    if slot and slot[0][slot[1]]:
        members = slot[0][slot[1]]
        members.insert(random.randrange(len(members) + 1), copy.deepcopy(random.choice(members)))


def double_key(random, model):
    slot = chosen(random, model, lambda member, name: isinstance(name, str))
    text = json.dumps(model.json, ensure_ascii=False)
    braces = [i for i, c in enumerate(text) if c == "{"]
    if slot and braces:
        at = random.choice(braces) + 1
        again = json.dumps(slot[2]) + ":" + json.dumps(slot[0][slot[1]], ensure_ascii=False)
        model.text = text[:at] + again + ("" if text[at:].lstrip().startswith("}") else ",") + text[at:]


def move_member(random, model):
    to, source = chosen(random, model), chosen(random, model)
    if to and source:
        to[0][to[1]] = copy.deepcopy(source[0][source[1]])


def make_cycle(random, model):
    nodes = model.json.get("nodes")
    if isinstance(nodes, list) and nodes and all(isinstance(node, dict) for node in nodes):
        node = random.choice(nodes)
        node["children"] = random.choice([[random.randrange(len(nodes))], list(range(len(nodes))), [0, 0]])


def add_extension(random, model):
    name = random.choice(EXTENSIONS)
    if random.random() < 0.3:
        model.json.setdefault("extensionsRequired", [])
        if isinstance(model.json["extensionsRequired"], list):
            model.json["extensionsRequired"].append(name)
        return
    slot = chosen(random, model, lambda member, name: isinstance(member, dict))
    source = chosen(random, model, lambda member, name: isinstance(member, dict))
    if slot:
        extensions = slot[0][slot[1]].setdefault("extensions", {})
        if isinstance(extensions, dict):
            extensions[name] = random.choice([{}, [], 1, copy.deepcopy(source[0][source[1]]),
                                              {"bufferView": random.randrange(8), "attributes": {"POSITION": random.randrange(4)}}])


def without_data(random, model):
    accessors = model.json.get("accessors")
    if isinstance(accessors, list) and accessors:
        accessor = random.choice(accessors)
        if isinstance(accessor, dict):
            accessor.pop("bufferView", None)
            if random.random() < 0.5:
                accessor["count"] = random.choice([1, 1000, 1 << 20, 1 << 26, 1 << 40])


def nest(random, model):
    depth = random.choice([10, 100, 300, 20000])
    opening, closing = random.choice([("[", "]"), ('{"a":', "}")])
    filling = '"extras":' + opening * depth + "0" + closing * depth
    text = json.dumps(model.json, ensure_ascii=False)
    model.text = "{" + filling + "," + text[1:]


def change_floats(random, model):
    for _ in range(random.choice([1, 1, 4, 50])):
        if len(model.binary) >= 4:
            at = random.randrange(len(model.binary) // 4) * 4
            model.binary[at:at + 4] = random.choice(STRANGE_FLOATS)


def scale_floats(random, model):
    """Multiplies a whole view of floats by a scale."""
    listed = model.json.get("bufferViews")
    views = [view for view in listed if isinstance(view, dict)] if isinstance(listed, list) else []
    if not views:
        return
    view, scale = random.choice(views), random.choice([1e-30, 1e-10, 1e10, 1e18, 2e18, 1e25, 1e35])
    begin, length = view.get("byteOffset", 0), view.get("byteLength", 0)
    if isinstance(begin, int) and isinstance(length, int) and 0 <= begin <= begin + length <= len(model.binary):
        for at in range(begin, begin + length - 3, 4):
            value, = struct.unpack_from("<f", model.binary, at)
            if value == value:
                struct.pack_into("<f", model.binary, at, max(-3.4e38, min(3.4e38, value * scale)))


def change_bytes(random, model):
    for _ in range(random.choice([1, 3, 20])):
        if model.binary:
            model.binary[random.randrange(len(model.binary))] = random.randrange(256)


def cut_binary(random, model):
    if model.binary:
        del model.binary[random.randrange(len(model.binary)):]


def break_container(random, model):
    kind, cut = random.randrange(4), random.random()
    word = random.choice([0, 1, 7, 1 << 31, (1 << 32) - 1, (1 << 32) - 8])
    at = random.choice([4, 8, 12, 16])

    def broken(whole):
        if kind == 0:
            return whole[:int(cut * len(whole))]
        if kind == 1:
            return whole + bytes(random.randrange(256) for _ in range(8))
        if kind == 2:
            i = int(cut * len(whole))
            return whole[:i] + bytes([whole[i] ^ 255]) + whole[i + 1:]
        return whole[:at] + struct.pack("<I", word) + whole[at + 4:]
    model.container = broken


def as_text(random, model):
    """Converts the model to a .gltf with its buffer in a URI."""
    buffers = model.json.get("buffers")
    if isinstance(buffers, list) and buffers and isinstance(buffers[0], dict):
        buffers[0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(model.binary).decode()
        text = json.dumps(model.json).encode()
        model.container = lambda whole: text


STRUCTURE = [change_number, change_number, change_size, change_size, change_index, change_type, change_string, add_name, delete_member,
             double_member, double_key, move_member, make_cycle, add_extension, without_data]
RARE = [nest, change_floats, change_floats, scale_floats, change_bytes, cut_binary, break_container, as_text]


def mutate(random, data):
    """Returns a changed copy of the bytes of a .glb."""
    model = Model(data)
    for _ in range(random.choice([1, 1, 1, 2, 3])):
        random.choice(STRUCTURE)(random, model)
    if random.random() < 0.3:
        random.choice(RARE)(random, model)
    return model.to_bytes()
