"""Binary G-code in a few lines, apart from the product: after libbgcode's specification and what PrusaSlicer writes."""
import functools
import struct
import zlib

FILE, GCODE, SLICER, PRINTER, PRINT, THUMBNAIL = range(6)
TABLE = "0123456789. \nGX"


def expand(data, window, size):
    """Heatshrink, with a lookahead of 4."""
    bits = "".join(f"{byte:08b}" for byte in data)
    out, at = bytearray(), 0

    def take(count):
        nonlocal at
        at += count
        return int(bits[at - count:at], 2)

    while len(out) < size:
        if take(1):
            out.append(take(8))
            continue
        distance, length = take(window) + 1, take(4) + 1
        for _ in range(length):
            out.append(out[-distance] if distance <= len(out) else 0)
    return bytes(out)


def unpack(data):
    """MeatPack; moves have no spaces."""
    out, on, table, at = bytearray(), False, TABLE, 0
    while at < len(data):
        if data[at:at + 2] == b"\xff\xff":
            command, at = data[at + 2], at + 3
            on = {251: True, 250: False, 249: False}.get(command, on)
            table = {247: TABLE.replace(" ", "E"), 246: TABLE}.get(command, table)
            continue
        byte, at = data[at], at + 1
        if not on:
            out.append(byte)
            continue
        for code in (byte & 15, byte >> 4):
            if code == 15:
                out.append(data[at])
                at += 1
            else:
                out.append(ord(table[code]))
                if table[code] == "\n":
                    break
    return bytes(out).decode()


def pack(text):
    """MeatPack without packing: all between its commands."""
    lines = ("".join(line.split(" ")) if line.startswith("G") and ";" not in line else line
             for line in text.splitlines(keepends=True))
    return b"\xff\xff\xfb\xff\xff\xf7\xff\xff\xfa" + "".join(lines).encode()


class Block:
    def __init__(self, raw, offset, kind, compression, size, parameters, data):
        self.raw, self.offset, self.kind, self.compression = raw, offset, kind, compression
        self.size, self.parameters, self.data = size, parameters, data

    @functools.cache  # the tests read it again and again
    def content(self):
        if self.compression == 1:
            content = zlib.decompress(self.data)
        elif self.compression:
            content = expand(self.data, 9 + self.compression, self.size)
        else:
            content = self.data
        assert len(content) == self.size
        return content

    @functools.cache
    def text(self):
        return unpack(self.content()) if self.parameters != b"\0\0" else self.content().decode()


class File:
    def __init__(self, checksum, blocks):
        self.checksum, self.blocks = checksum, blocks

    def text(self):
        return "".join(block.text() for block in self.blocks if block.kind == GCODE)


def parse(data):
    magic, version, checksum = struct.unpack_from("<4sIH", data)
    assert (magic, version) == (b"GCDE", 1)
    blocks, at = [], 10
    while at < len(data):
        begin = at
        kind, compression, size = struct.unpack_from("<HHI", data, at)
        stored, at = size, at + 8
        if compression:
            (stored,), at = struct.unpack_from("<I", data, at), at + 4
        parameters = 6 if kind == THUMBNAIL else 2
        content = data[at + parameters:at + parameters + stored]
        parameters, at = data[at:at + parameters], at + parameters + stored
        if checksum:
            assert struct.unpack_from("<I", data, at)[0] == zlib.crc32(data[begin:at])
            at += 4
        blocks.append(Block(data[begin:at], begin, kind, compression, size, parameters, content))
    return File(checksum, blocks)


def shrink(data):
    """Heatshrink of letters alone."""
    bits = "".join(f"1{byte:08b}" for byte in data)
    bits += "0" * (-len(bits) % 8)
    return int(bits, 2).to_bytes(len(bits) // 8, "big")


def encode(text, metadata, thumbnails=(), checksum=1, compression=3, encoding=2):
    out = struct.pack("<4sIH", b"GCDE", 1, checksum)

    def add(kind, packed, parameters, content):
        nonlocal out
        data = {0: bytes, 1: zlib.compress}.get(packed, shrink)(content)
        block = struct.pack("<HHI", kind, packed, len(content))
        if packed:
            block += struct.pack("<I", len(data))
        block += struct.pack(f"<{len(parameters)}H", *parameters) + data
        out += block + (struct.pack("<I", zlib.crc32(block)) if checksum else b"")

    add(FILE, 0, (0,), metadata["file"].encode())
    add(PRINTER, 0, (0,), metadata["printer"].encode())
    for form, width, height, picture in thumbnails:
        add(THUMBNAIL, 0, (form, width, height), picture)
    add(PRINT, 1, (0,), metadata["print"].encode())
    add(SLICER, 1, (0,), metadata["slicer"].encode())
    lines = text.splitlines(keepends=True)
    while lines:
        part = ""
        while lines and len(part) + len(lines[0]) <= 60000:
            part += lines.pop(0)
        add(GCODE, compression, (encoding,), pack(part) if encoding else part.encode())
    return out
