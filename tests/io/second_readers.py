#!/usr/bin/env python3
"""What other programs read in a scan: size, position in the world, range of values.

    second_readers.py ROOT < paths          paths relative to ROOT, one a line

Prints one line of JSON for each path: {"path", "reader", "size": [nx, ny, nz], "step": [[x, y, z] of i, j, k],
"origin": [x, y, z] (LPS, mm), "low", "high"}, or {"path", "reader", "refuses": why}.

The readers: for NRRD teem's unu; for NIfTI nifti_tool (geometry), and the bytes at the place it reports; for DICOM files
gdcminfo and gdcmconv, for folders dcm2niix and then nifti_tool. Of several volumes in one file the first is read. Debian has no small reader of MetaImage, so the few
lines of read_meta below read it; they follow its documentation, not burr.
"""
import array
import concurrent.futures
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib


class Refuses(Exception):
    """The other program does not read it."""


def output_of(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, timeout=60)
    text = done.stdout.decode(errors="replace")
    if done.returncode != 0:
        raise Refuses((done.stderr.decode(errors="replace") or text).strip().splitlines()[:1])
    return text


def floats(text):
    return [float(word) for word in re.split(r"[\s,()\\]+", text) if word]


def spread(raw, code, big):
    """Lowest and highest number, without NaN."""
    numbers = array.array(code)
    numbers.frombytes(raw[: len(raw) - len(raw) % numbers.itemsize])
    if big != (sys.byteorder == "big"):
        numbers.byteswap()
    if code in "fd":
        numbers = [n for n in numbers if n - n == 0]
    return min(numbers), max(numbers)


# ---- NRRD, by teem
def read_nrrd(path):
    fields = {}
    for line in output_of("teem-unu", "head", path).splitlines():
        if ": " in line and not line.startswith("#"):
            name, value = line.split(": ", 1)
            fields[name.strip()] = value.strip()
    sizes = [int(n) for n in fields["sizes"].split()]
    moves = re.findall(r"\([^)]*\)|none", fields.get("space directions", ""))
    kept = [a for a in range(len(sizes)) if len(sizes) == 3 or sizes[a] > 1]
    kinds = fields.get("kinds", "").split() or ["?"] * len(sizes)
    others = [a for a in kept if kinds[a] not in ("space", "domain")]
    volumes = others[0] if len(kept) == 4 and len(others) == 1 else None
    kept = [a for a in kept if a != volumes]
    if len(kept) != 3:
        raise Refuses("not three axes")
    spacings = (fields.get("spacings", "") + " nan" * 9).split()
    step = []
    for place, axis in enumerate(kept):
        if moves and moves[axis] != "none":
            step.append(floats(moves[axis]))
        else:
            gap = abs(float(spacings[axis]))
            step.append([gap if gap > 0 and b == place else float(b == place) for b in range(3)])
    origin = floats(fields.get("space origin", "0 0 0"))
    space = fields.get("space", "").lower()
    flip = [1, 1, 1]
    if space.startswith("right-anterior") or space == "ras":
        flip = [-1, -1, 1]
    if space.startswith("left-anterior") or space == "las":
        flip = [1, -1, 1]
    if space.startswith("3d-left"):
        flip = [1, 1, -1]
    with tempfile.TemporaryDirectory() as folder:
        one = path
        if volumes is not None:
            one = pathlib.Path(folder) / "one.nrrd"
            output_of("teem-unu", "slice", "-a", volumes, "-p", "0", "-i", path, "-o", one)
        range_text = output_of("teem-unu", "minmax", one)
    low, high = (float(re.search(f"{what}: (\\S+)", range_text).group(1)) for what in ("min", "max"))
    return {
        "reader": "unu",
        "size": [sizes[a] for a in kept],
        "step": [[f * x for f, x in zip(flip, move)] for move in step],
        "origin": [f * x for f, x in zip(flip, origin)],
        "low": low,
        "high": high,
    }


# ---- NIfTI, by libniftiio
NIFTI_CODES = {2: "B", 4: "h", 8: "i", 16: "f", 64: "d", 256: "b", 512: "H", 768: "I", 1024: "q", 1280: "Q"}


def unpacked(path):
    raw = pathlib.Path(path).read_bytes()
    return zlib.decompressobj(31).decompress(raw) if raw[:2] == b"\x1f\x8b" else raw


def other_half(path):
    """For a pair, the file with the voxels."""
    for name in (re.sub(r"\.hdr(\.gz)?$", ".img", path.name), re.sub(r"\.hdr(\.gz)?$", ".img.gz", path.name)):
        if name != path.name and (path.parent / name).exists():
            return path.parent / name
    return path


def read_nifti(path):
    fields = {}
    for line in output_of("nifti_tool", "-disp_nim", "-infiles", path).splitlines():
        words = line.split()
        if len(words) >= 4 and words[1].isdigit() and words[2].isdigit():
            fields[words[0]] = words[3:]
    if "nx" not in fields:
        raise Refuses("no header")
    number = lambda name: float(fields[name][0])
    sizes = [max(1, int(fields[n][0])) for n in ("nx", "ny", "nz")]
    # the file must say which of the two it is; the standard prefers sform
    name = "sto_xyz" if number("sform_code") > 0 else "qto_xyz" if number("qform_code") > 0 else None
    scale = {1: 1000.0, 3: 0.001}.get(int(number("xyz_units")), 1.0)
    if name:
        m = [float(x) * scale for x in fields[name]]
    else:
        m = [number("dx") * scale, 0, 0, 0, 0, number("dy") * scale, 0, 0, 0, 0, number("dz") * scale, 0]
    flip = [-1, -1, 1]
    code = NIFTI_CODES[int(number("datatype"))]
    data = unpacked(other_half(path))
    at = int(number("iname_offset"))
    count = sizes[0] * sizes[1] * sizes[2] * int(number("nbyper"))
    big = number("byteorder") == 2
    if len(data) < at + count:
        raise Refuses("cut off")
    low, high = spread(data[at : at + count], code, big)
    slope, intercept = number("scl_slope"), number("scl_inter")
    # nifti_tool prints six decimals, and a slope may be 0.003: the header has all its digits
    head, order = unpacked(path), ">" if big else "<"
    places = {348: ("2f", 112), 540: ("2d", 176)}.get(struct.unpack_from(order + "i", head)[0])  # none: an .img
    if places:
        exact = struct.unpack_from(order + places[0], head, places[1])
        if max(abs(exact[0] - slope), abs(exact[1] - intercept)) < 1e-6:
            slope, intercept = exact
    if slope not in (0, 1) or (slope == 1 and intercept):
        low, high = sorted((low * slope + intercept, high * slope + intercept))
    return {
        "reader": "nifti_tool",
        "size": sizes,
        "step": [[flip[b] * m[4 * b + a] for b in range(3)] for a in range(3)],
        "origin": [flip[b] * m[4 * b + 3] for b in range(3)],
        "low": low,
        "high": high,
    }


# ---- MetaImage, after https://itk.org/Wiki/ITK/MetaIO/Documentation
META_CODES = {"CHAR": "b", "UCHAR": "B", "SHORT": "h", "USHORT": "H", "INT": "i", "UINT": "I", "LONG": "i",
              "ULONG": "I", "LONG_LONG": "q", "ULONG_LONG": "Q", "FLOAT": "f", "DOUBLE": "d"}


def read_meta(path):
    raw = pathlib.Path(path).read_bytes()
    fields, at = {}, 0
    while "ElementDataFile" not in fields:
        end = raw.find(b"\n", at)
        if end < 0:
            raise Refuses("no ElementDataFile")
        name, _, value = raw[at:end].decode("latin-1").partition("=")
        fields[name.strip()] = value.strip()
        at = end + 1
    true = lambda name: fields.get(name, "False").lower() in ("true", "1")
    sizes = [int(n) for n in fields["DimSize"].split()]
    code = META_CODES[fields["ElementType"].replace("MET_", "")]
    if fields["ElementDataFile"].upper() == "LOCAL":
        data = raw[at:]
    else:
        data = (pathlib.Path(path).parent / fields["ElementDataFile"]).read_bytes()
    if true("CompressedData"):
        data = zlib.decompressobj().decompress(data)
    count = sizes[0] * sizes[1] * sizes[2] * array.array(code).itemsize
    skip = int(fields.get("HeaderSize", "0"))
    data = data[len(data) - count :] if skip < 0 else data[skip : skip + count]
    first = lambda *names: next((fields[n] for n in names if n in fields), "")
    low, high = spread(data, code, true("BinaryDataByteOrderMSB") or true("ElementByteOrderMSB"))
    slope = float(fields.get("ElementToIntensityFunctionSlope", 1))
    intercept = float(fields.get("ElementToIntensityFunctionOffset", 0))
    turn = floats(first("TransformMatrix", "Rotation", "Orientation")) or [1, 0, 0, 0, 1, 0, 0, 0, 1]
    gaps = [abs(g) for g in floats(first("ElementSpacing", "ElementSize"))] or [1, 1, 1]
    return {
        "reader": "second_readers.py",
        "size": sizes,
        "step": [[turn[3 * a + b] * gaps[a] for b in range(3)] for a in range(3)],
        "origin": floats(first("Offset", "Position", "Origin")) or [0, 0, 0],
        "low": low * slope + intercept,
        "high": high * slope + intercept,
    }


# ---- DICOM, by GDCM's tools and by dcm2niix
def read_dicom_file(path):
    facts = dict(re.findall(r"^([^:\n]+?)\s*: ?(.*)$", output_of("gdcminfo", path), re.M))
    rescale = re.search(r"Rescale Intercept/Slope: \((\S+),(\S+)\)", output_of("gdcminfo", path))
    size = [int(n) for n in floats(facts["Dimensions"])]
    if int(facts["SamplesPerPixel"]) != 1:
        raise Refuses("colours")
    cosines, gaps = floats(facts["DirectionCosines"]), floats(facts["Spacing"])
    row, column = cosines[:3], cosines[3:]
    normal = [row[1] * column[2] - row[2] * column[1], row[2] * column[0] - row[0] * column[2],
              row[0] * column[1] - row[1] * column[0]]
    bits, stored = int(facts["BitsAllocated"]), int(facts["BitsStored"])
    signed = int(facts["PixelRepresentation"]) == 1
    with tempfile.TemporaryDirectory() as folder:
        plain, pixels = pathlib.Path(folder) / "plain.dcm", pathlib.Path(folder) / "pixels"
        output_of("gdcmconv", "--raw", "--explicit", path, plain)
        output_of("gdcmraw", "-i", plain, "-t", "7fe0,0010", "-o", pixels)
        raw = pixels.read_bytes()
    codes = {8: "B", 16: "H", 32: "I"}
    numbers = array.array(codes[bits])
    count = size[0] * size[1] * size[2]
    numbers.frombytes(raw[: count * numbers.itemsize])
    shift = int(facts["HighBit"]) - stored + 1
    different = {(n >> shift) & ((1 << stored) - 1) for n in set(numbers)}
    if signed:
        different = {n - (1 << stored) if n >= 1 << (stored - 1) else n for n in different}
    intercept, slope = float(rescale.group(1)), float(rescale.group(2))
    ends = sorted((min(different) * slope + intercept, max(different) * slope + intercept))
    return {
        "reader": "gdcm",
        "size": size,
        "step": [[gaps[0] * x for x in row], [gaps[1] * x for x in column], [gaps[2] * x for x in normal]],
        "origin": floats(facts["Origin"]),
        "low": ends[0],
        "high": ends[1],
    }


def read_dicom_folder(path):
    with tempfile.TemporaryDirectory() as folder:
        output_of("dcm2niix", "-z", "n", "-b", "n", "-f", "other%s_%d", "-w", "1", "-o", folder, path)
        made = sorted(pathlib.Path(folder).glob("*.nii"))
        # of a shifted or uneven stack it also writes the raw version
        made = [one for one in made if "Tilt" in one.name or "_Eq" in one.name] or made
        if not made:
            raise Refuses("no volume")
        if len(made) > 1:
            raise Refuses(f"{len(made)} volumes")
        found = read_nifti(made[0])
    found["reader"] = "dcm2niix"
    return found


def look(root, name):
    path = root / name
    lower = path.name.lower()
    try:
        head = b"" if path.is_dir() else path.read_bytes()[:132]
        if path.is_dir():
            found = read_dicom_folder(path)
        elif head[:4] == b"NRRD":
            found = read_nrrd(path)
        elif lower.endswith((".mha", ".mhd")):
            found = read_meta(path)
        elif lower.endswith((".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz")):
            found = read_nifti(path)
        else:
            found = read_dicom_file(path)
    except Refuses as why:
        found = {"refuses": str(why)}
    except Exception as why:  # any answer of a reader that is not a scan
        found = {"refuses": f"{type(why).__name__}: {why}"}
    found["path"] = name
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    names = [line.rstrip("\n") for line in sys.stdin]
    with concurrent.futures.ThreadPoolExecutor(2) as workers:
        for found in workers.map(lambda name: look(root, name), names):
            print(json.dumps(found))


if __name__ == "__main__":
    sys.exit(main())
