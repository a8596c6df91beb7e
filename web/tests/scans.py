"""Small scans for the test of the page: a ball of bone, in each format that a page reads, and scans that it refuses."""
import gzip
import math
import struct
import zlib

EDGE, SPACING, RADIUS = 40, 0.5, 8.0  # [voxel], [mm], [mm]
MM3 = 4 / 3 * math.pi * RADIUS ** 3


def _voxels():
    """HU, x fastest, as slices."""
    middle = (EDGE - 1) / 2
    for z in range(EDGE):
        slice_ = []
        for y in range(EDGE):
            for x in range(EDGE):
                far = SPACING * math.dist((x, y, z), (middle, middle, middle))
                slice_.append(int(max(-1000, min(1000, 300 + 1000 * (RADIUS - far)))))
        yield struct.pack(f"<{len(slice_)}h", *slice_)


SLICES = list(_voxels())
RAW = b"".join(SLICES)
UNCOMPRESSED, DEFLATED = "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.1.99"
LOSSLESS, LOSSY = "1.2.840.10008.1.2.4.70", "1.2.840.10008.1.2.4.51"
RLE = "1.2.840.10008.1.2.5"


def nrrd(encoding="gzip"):
    """grey: bytes that are no Hounsfield units."""
    head = (f"NRRD0004\ntype: {'uint8' if encoding == 'grey' else 'short'}\ndimension: 3\nspace: left-posterior-superior\nsizes: {EDGE} {EDGE} {EDGE}\n"
            f"space directions: ({SPACING},0,0) (0,{SPACING},0) (0,0,{SPACING})\nspace origin: (0,0,0)\n"
            f"endian: little\nencoding: {'raw' if encoding == 'grey' else encoding}\n\n").encode()
    if encoding == "grey":
        return head + bytes(one >> 2 & 0xFF for one in (value + 1000 for value in struct.unpack(f"<{EDGE ** 3}h", RAW)))
    return head + (gzip.compress(RAW) if encoding == "gzip" else b"BZh91AY&SY" + bytes(100) if encoding == "bzip2" else RAW)


def nifti():
    head = bytearray(352)
    struct.pack_into("<i", head, 0, 348)
    struct.pack_into("<8h", head, 40, 3, EDGE, EDGE, EDGE, 1, 1, 1, 1)
    struct.pack_into("<2h", head, 70, 4, 16)  # int16
    struct.pack_into("<8f", head, 76, 1, SPACING, SPACING, SPACING, 0, 0, 0, 0)
    struct.pack_into("<3f", head, 108, 352, 1, 0)
    head[123] = 2  # mm
    struct.pack_into("<2h", head, 252, 0, 1)
    struct.pack_into("<12f", head, 280, -SPACING, 0, 0, 0, 0, -SPACING, 0, 0, 0, 0, SPACING, 0)
    head[344:348] = b"n+1\0"
    return gzip.compress(bytes(head) + RAW)


def meta():
    packed = zlib.compress(RAW)
    return (f"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = True\n"
            f"CompressedDataSize = {len(packed)}\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\n"
            f"ElementSpacing = {SPACING} {SPACING} {SPACING}\nDimSize = {EDGE} {EDGE} {EDGE}\nElementType = MET_SHORT\n"
            f"ElementDataFile = LOCAL\n").encode() + packed


def _runs(pixels):
    """In DICOM's run lengths: the high bytes, then the low ones, in runs of one byte or of two and more that are the same."""
    parts = []
    for one in (pixels[1::2], pixels[::2]):
        out, at = bytearray(), 0
        while at < len(one):
            end = at + 1
            while end < len(one) and one[end] == one[at] and end - at < 128:
                end += 1
            out += bytes([(257 - (end - at)) % 256, one[at]])
            at = end
        parts.append(bytes(out) + b"\0" * (len(out) % 2))
    return struct.pack("<16I", 2, 64, 64 + len(parts[0]), *[0] * 13) + parts[0] + parts[1]


def dicom(syntax=UNCOMPRESSED, series="1.2.3.0", pixels_too=True):
    """The slices of a series; compressed ones have a head and nothing behind it."""
    def element(tag, kind, value):
        if isinstance(value, str):
            value = value.encode() + (b"\0" if kind == "UI" else b" ") * (len(value) % 2)
        elif isinstance(value, int):
            value = struct.pack("<H", value)
        head = struct.pack("<HH2s", tag >> 16, tag & 0xFFFF, kind.encode())
        return head + (struct.pack("<HI", 0, len(value)) if kind in ("OW", "OB") else struct.pack("<H", len(value))) + value

    for k, pixels in enumerate(SLICES):
        meta_head = element(0x00020010, "UI", syntax)
        body = b"".join(element(*one) for one in (
            (0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2"), (0x00080018, "UI", f"{series}.{k + 1}"), (0x00080060, "CS", "CT"),
            (0x00180050, "DS", f"{SPACING}"), (0x0020000D, "UI", "1.2.3"), (0x0020000E, "UI", series),
            (0x00200013, "IS", f"{k + 1}"), (0x00200032, "DS", f"0\\0\\{k * SPACING}"),
            (0x00200037, "DS", "1\\0\\0\\0\\1\\0"), (0x00280002, "US", 1), (0x00280004, "CS", "MONOCHROME2"),
            (0x00280010, "US", EDGE), (0x00280011, "US", EDGE), (0x00280030, "DS", f"{SPACING}\\{SPACING}"),
            (0x00280100, "US", 16), (0x00280101, "US", 16), (0x00280102, "US", 15), (0x00280103, "US", 1),
            (0x00281052, "DS", "0"), (0x00281053, "DS", "1")))
        if not pixels_too:
            pass
        elif syntax in (LOSSLESS, LOSSY, RLE):
            picture = (bytes.fromhex("FFD8FFC3000B10") + struct.pack(">HH", EDGE, EDGE) + bytes.fromhex("01011100FFD9"))
            picture = _runs(pixels) if syntax == RLE else picture
            parts = b"".join(struct.pack("<HHI", 0xFFFE, 0xE000, len(one)) + one for one in (b"", picture + b"\0" * (len(picture) % 2)))
            body += struct.pack("<HH2sHI", 0x7FE0, 0x0010, b"OB", 0, 0xFFFFFFFF) + parts + struct.pack("<HHI", 0xFFFE, 0xE0DD, 0)
        else:
            body += element(0x7FE00010, "OW", pixels)
        if syntax == DEFLATED:
            packer = zlib.compressobj(9, zlib.DEFLATED, -15)
            body = packer.compress(body) + packer.flush()
        yield (bytes(128) + b"DICM" + element(0x00020000, "UL", struct.pack("<I", len(meta_head))) + meta_head + body)
