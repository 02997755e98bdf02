# A MAT-file of version 5 as JSON, by nothing but the description of the format: read_mat.py FILE. Numbers are lists of rows, NaN and infinite ones
# texts; a struct array has its elements in a list, one of 1 x 1 is an object.
import json, math, struct, sys, zlib

FORMATS = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 9: "d", 12: "q", 13: "Q"}


def element(data, at):
    """Type, bytes and the place after the element that starts at `at`."""
    kind, size = struct.unpack_from("<II", data, at)
    if kind >> 16:  # the small form: both in four bytes
        kind, size = kind & 0xFFFF, kind >> 16
        return kind, data[at + 4:at + 4 + size], at + 8
    padding = 0 if kind == 15 else -size % 8
    return kind, data[at + 8:at + 8 + size], at + 8 + size + padding


def numbers(kind, data):
    form = FORMATS[kind]
    return struct.unpack("<%d%s" % (len(data) // struct.calcsize(form), form), data)


def shown(x):
    if math.isnan(x):
        return "nan"
    return ("inf" if x > 0 else "-inf") if math.isinf(x) else x


def matrix(data):
    """Name and value of a matrix element."""
    if not data:
        return "", []
    _, flags, at = element(data, 0)
    kind = flags[0]
    _, dims, at = element(data, at)
    rows, cols = struct.unpack("<ii", dims)
    _, name, at = element(data, at)
    name = name.decode("ascii")
    if kind == 1:  # cells
        items = []
        for _ in range(rows * cols):
            _, content, at = element(data, at)
            items.append(matrix(content)[1])
        return name, items
    if kind == 2:  # structs
        _, size, at = element(data, at)
        width = struct.unpack("<i", size)[0]
        _, text, at = element(data, at)
        fields = [text[i:i + width].split(b"\0")[0].decode("ascii") for i in range(0, len(text), width)]
        structs = []
        for _ in range(rows * cols):
            one = {}
            for field in fields:
                _, content, at = element(data, at)
                one[field] = matrix(content)[1]
            structs.append(one)
        return name, structs[0] if rows * cols == 1 else structs
    if kind == 4:  # characters
        if rows * cols == 0:
            return name, ""
        content_kind, content, at = element(data, at)
        return name, content.decode({16: "utf-8", 17: "utf-16-le", 4: "utf-16-le", 1: "ascii", 2: "ascii"}[content_kind])
    assert kind == 6, "class %d" % kind
    content = numbers(*element(data, at)[:2])
    assert len(content) == rows * cols
    return name, [[shown(content[i + j * rows]) for j in range(cols)] for i in range(rows)]


data = open(sys.argv[1], "rb").read()
assert data[124:128] == b"\0\1IM", "not version 5, little-endian"
variables, at = {}, 128
while at < len(data):
    kind, content, at = element(data, at)
    if kind == 15:
        kind, content, _ = element(zlib.decompress(content), 0)
    assert kind == 14
    name, value = matrix(content)
    variables[name] = value
json.dump(variables, sys.stdout, ensure_ascii=False)
