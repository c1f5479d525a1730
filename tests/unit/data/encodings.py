"""Writes one small mesh in the encodings that VTK's XML files have: encodings.py, in this folder.

Three tets and two triangles in groups; by zlib and base64 of Python."""
import base64
import struct
import zlib

POINTS = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 1 / 3, -0.1, -2.5]
CELLS = [(10, (0, 1, 2, 3)), (10, (1, 2, 3, 4)), (10, (0, 2, 1, 5)), (5, (1, 2, 4)), (5, (0, 3, 2)), (3, (0, 1))]
GROUPS = {"group:a%20b": [1, 0, 0, 0, 0, 0], "group:skin": [0, 0, 0, 1, 1, 0]}
POINT_GROUPS = {"group:tip": [0, 0, 0, 0, 0, 1]}
KINDS = {"Float64": "d", "Float32": "f", "Int64": "q", "Int32": "i", "UInt8": "B", "Int8": "b"}


def write(name, encoding, compress=False, big=False, wide=False, real="Float64", whole="Int32", block=40, level=-1):
    order, head = (">" if big else "<"), ("Q" if wide else "I")
    appended = bytearray()

    def lengths(*n):
        return struct.pack(f"{order}{len(n)}{head}", *n)

    def encoded(data, base):
        if not compress:
            whole_data = lengths(len(data)) + data
            return base64.b64encode(whole_data) if base else whole_data
        parts = [data[i:i + block] for i in range(0, len(data), block)]
        packed = [zlib.compress(p, level) for p in parts]
        last = len(parts[-1]) % block
        header, body = lengths(len(parts), block, last, *map(len, packed)), b"".join(packed)
        return base64.b64encode(header) + base64.b64encode(body) if base else header + body

    def array(name, kind, values, ncomponent=1):
        tag = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{ncomponent}" '
        if encoding == "ascii":
            return tag + 'format="ascii">\n' + " ".join(map(repr, values)) + "\n</DataArray>\n"
        data = struct.pack(f"{order}{len(values)}{KINDS[kind]}", *values)
        if encoding == "binary":
            return tag + 'format="binary">\n ' + encoded(data, True).decode() + "\n</DataArray>\n"
        offset = len(appended)
        appended.extend(encoded(data, encoding == "base64"))
        return tag + f'format="appended" offset="{offset}"/>\n'

    ends, nodes = [], []
    for _, cell in CELLS:
        nodes += cell
        ends.append(len(nodes))
    text = '<?xml version="1.0"?>\n<!-- a <Piece> in a comment -->\n<VTKFile type="UnstructuredGrid" version="1.0" '
    text += f'byte_order="{"BigEndian" if big else "LittleEndian"}" header_type="UInt{64 if wide else 32}"'
    text += (' compressor="vtkZLibDataCompressor"' if compress else "") + ">\n<UnstructuredGrid>\n"
    text += f'<Piece NumberOfPoints="{len(POINTS) // 3}" NumberOfCells="{len(CELLS)}">\n<PointData>\n'
    text += array("u", "Float32", POINTS, 3)
    text += "".join(array(n, "UInt8", v) for n, v in POINT_GROUPS.items()) + "</PointData>\n<CellData>\n"
    text += "".join(array(n, "Int8", v) for n, v in GROUPS.items()) + "</CellData>\n<Points>\n"
    text += array("Points", real, POINTS, 3) + "</Points>\n<Cells>\n"
    text += array("connectivity", whole, nodes) + array("offsets", whole, ends)
    text += array("types", "UInt8", [t for t, _ in CELLS]) + "</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    out = text.encode()
    if appended:
        out += f'<AppendedData encoding="{encoding}">\n_'.encode() + bytes(appended) + b"\n</AppendedData>\n"
    with open(name, "wb") as file:
        file.write(out + b"</VTKFile>\n")


write("encoded.ascii.vtu", "ascii")
write("encoded.binary.vtu", "binary", real="Float32", whole="Int64")
write("encoded.binary.big.vtu", "binary", big=True, wide=True)
write("encoded.zlib.vtu", "binary", compress=True, whole="Int64")
write("encoded.raw.vtu", "raw", wide=True)
write("encoded.raw.zlib.big.vtu", "raw", compress=True, big=True)
write("encoded.base64.vtu", "base64")
write("encoded.base64.zlib.vtu", "base64", compress=True, wide=True, whole="Int64", block=1000)
write("encoded.stored.vtu", "binary", compress=True, level=0)
