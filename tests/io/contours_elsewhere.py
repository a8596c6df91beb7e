#!/usr/bin/env python3
"""Contours (RTSTRUCT) that pydicom writes, read by burr and written as a DICOM label map: every voxel is that of an even-odd rule
in numpy. Random stars with holes, on the slices of a straight and of an oblique CT, in implicit and explicit files.

    tests/io/contours_elsewhere.py BURR [SEED]         exit code 77: pydicom is not here
"""
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
    import pydicom
    from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
    from pydicom.sequence import Sequence
    from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, ImplicitVRLittleEndian, RTStructureSetStorage, generate_uid
except ImportError:  # the packages of Debian belong to Debian's Python
    if "again" not in sys.argv and pathlib.Path("/usr/bin/python3").exists():
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv, "again"])
    print("skipped: python3-pydicom is not installed; scripts/install_packages.sh test")
    sys.exit(77)

WORDS = [w for w in sys.argv[1:] if w != "again"]
BURR = pathlib.Path(WORDS[0]).resolve()
SEED = int(WORDS[1]) if len(WORDS) > 1 else int.from_bytes(os.urandom(4), "little")
LABEL_MAP = "1.2.840.10008.5.1.4.1.1.66.7"
NX, NY, NZ = 44, 40, 18
SPACING = numpy.array([0.7, 0.9, 1.5])


def new_file(path, sop_class, syntax):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID, meta.TransferSyntaxUID = sop_class, generate_uid(), syntax
    file = FileDataset(str(path), {}, file_meta=meta, preamble=b"\0" * 128)
    file.is_little_endian, file.is_implicit_VR = True, syntax == ImplicitVRLittleEndian
    file.SOPClassUID, file.SOPInstanceUID = sop_class, meta.MediaStorageSOPInstanceUID
    file.PatientName, file.PatientID, file.StudyInstanceUID = "Test^Contours", "1", "1.2.3.4"
    return file


def write_ct(folder, axes, origin, frame):
    series = generate_uid()
    for k in range(NZ):
        file = new_file(folder / f"ct{k:02}.dcm", CTImageStorage, ExplicitVRLittleEndian)
        file.Modality, file.SeriesInstanceUID, file.FrameOfReferenceUID, file.InstanceNumber = "CT", series, frame, k + 1
        file.ImagePositionPatient = [f"{v:.9g}" for v in origin + axes[:, 2] * SPACING[2] * k]
        file.ImageOrientationPatient = [f"{v:.9g}" for v in (*axes[:, 0], *axes[:, 1])]
        file.PixelSpacing, file.SliceThickness = [SPACING[1], SPACING[0]], SPACING[2]
        file.Rows, file.Columns, file.SamplesPerPixel, file.PhotometricInterpretation = NY, NX, 1, "MONOCHROME2"
        file.BitsAllocated = file.BitsStored = 16
        file.HighBit, file.PixelRepresentation, file.RescaleSlope, file.RescaleIntercept = 15, 0, 1, -1024
        file.PixelData = numpy.random.default_rng(k).integers(900, 1100, (NY, NX)).astype("<u2").tobytes()
        file.save_as(folder / f"ct{k:02}.dcm")
    return series


def star(random, middle, low, high, points):
    """Corners in pixels."""
    angle = numpy.sort(random.uniform(0, 2 * numpy.pi, points))
    radius = random.uniform(low, high, points)
    return middle + numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle)], 1)


def even_odd(curves, aside=0.0):
    """Which centres of pixels (j, i) are inside; corners in pixels. aside: the centres are moved so far along i."""
    x, y = numpy.meshgrid(numpy.arange(NX) + aside, numpy.arange(NY))
    inside = numpy.zeros((NY, NX), bool)
    for curve in curves:
        for a, b in zip(curve, numpy.roll(curve, -1, 0)):
            if a[1] == b[1]:
                continue
            crosses = (a[1] > y) != (b[1] > y)
            at = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            inside ^= crosses & (x < at)
    return inside


def draw(random, count):
    """Of each structure, the curves of each slice."""
    structures = []
    for n in range(count):
        middle = numpy.array([NX, NY]) / 2 + random.uniform(-6, 6, 2)
        size = random.uniform(5, 13)
        first, last = sorted(random.choice(NZ, 2, replace=False))
        curves = {}
        for k in range(first, last + 1):
            here = [star(random, middle, 0.7 * size, size, 24)]
            if n % 2 == 0:
                here.append(star(random, middle, 0.2 * size, 0.4 * size, 11))
            curves[k] = here
        structures.append(curves)
    return structures


def write_contours(path, structures, axes, origin, frame, series, syntax):
    file = new_file(path, RTStructureSetStorage, syntax)
    file.Modality, file.SeriesInstanceUID, file.StructureSetLabel = "RTSTRUCT", generate_uid(), "test"
    referenced, study, one = Dataset(), Dataset(), Dataset()
    one.SeriesInstanceUID = series
    study.RTReferencedSeriesSequence = Sequence([one])
    referenced.FrameOfReferenceUID, referenced.RTReferencedStudySequence = frame, Sequence([study])
    file.ReferencedFrameOfReferenceSequence = Sequence([referenced])
    file.StructureSetROISequence, file.ROIContourSequence, file.RTROIObservationsSequence = Sequence(), Sequence(), Sequence()
    for n, curves in enumerate(structures):
        roi, drawn, seen = Dataset(), Dataset(), Dataset()
        roi.ROINumber, roi.ROIName, roi.ReferencedFrameOfReferenceUID = n + 1, f"part {n + 1}", frame
        drawn.ReferencedROINumber, drawn.ROIDisplayColor, drawn.ContourSequence = n + 1, [10 * n, 200, 30], Sequence()
        seen.ObservationNumber, seen.ReferencedROINumber, seen.RTROIInterpretedType = n, n + 1, "ORGAN"
        for k, all_here in curves.items():
            for curve in all_here:
                contour = Dataset()
                at = origin + (curve * SPACING[:2]) @ axes[:, :2].T + axes[:, 2] * SPACING[2] * k
                contour.ContourGeometricType, contour.NumberOfContourPoints = "CLOSED_PLANAR", len(curve)
                contour.ContourData = [f"{v:.9g}" for v in at.ravel()]
                drawn.ContourSequence.append(contour)
        file.StructureSetROISequence.append(roi)
        file.ROIContourSequence.append(drawn)
        file.RTROIObservationsSequence.append(seen)
    file.save_as(path)


def labels_in(path):
    """The label map (k, j, i), its names, and the places of its frames."""
    file = pydicom.dcmread(path)
    assert file.SOPClassUID == LABEL_MAP and file.SegmentationType == "LABELMAP"
    names = {int(s.SegmentNumber): str(s.SegmentLabel) for s in file.SegmentSequence}
    places = [[float(n) for n in g.PlanePositionSequence[0].ImagePositionPatient] for g in file.PerFrameFunctionalGroupsSequence]
    pixels = numpy.asarray(file.pixel_array)
    return pixels if pixels.ndim == 3 else pixels[None], names, numpy.array(places)


def compare(random, axes, syntax):
    origin, frame = numpy.array([-11.5, 20.25, 300]), generate_uid()
    structures = draw(random, 5)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "in"
        folder.mkdir()
        series = write_ct(folder, axes, origin, frame)
        write_contours(folder / "rs.dcm", structures, axes, origin, frame, series, syntax)
        out = pathlib.Path(name) / "out.dcm"
        done = subprocess.run([BURR, "--quiet", "export", folder, "--series", "#2", "--part", "labels", "--seg-kind", "labelmap",
                               "--out", out], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        pixels, names, places = labels_in(out)
        assert pydicom.dcmread(out).FrameOfReferenceUID == frame
    wanted = numpy.zeros((NZ, NY, NX), numpy.uint8)
    masks = []
    near = numpy.zeros((NZ, NY, NX), bool)  # so near to an edge that rounding decides
    for curves in structures:
        mask = numpy.zeros((NZ, NY, NX), bool)
        for k, here in curves.items():
            mask[k] = even_odd(here)
            near[k] |= even_odd(here, 1e-5) != even_odd(here, -1e-5)
        masks.append(mask)
    order = sorted(range(len(masks)), key=lambda n: (-int(masks[n].sum()), n))
    for n in order:  # the smaller one stays
        wanted[masks[n]] = n + 1
    assert names == {0: "Background", **{n: f"part {n}" for n in map(int, numpy.unique(wanted)) if n > 0}}, names
    got = numpy.zeros_like(wanted)
    for frame_pixels, place in zip(pixels, places):
        k = int(round(float(numpy.dot(place - origin, axes[:, 2])) / SPACING[2]))
        assert numpy.allclose(origin + axes[:, 2] * SPACING[2] * k, place, atol=1e-5)
        got[k] = frame_pixels
    assert near.sum() < 10 and ((got == wanted) | near).all(), f"{int((got != wanted).sum())} of {int((wanted != 0).sum())} voxels differ"
    return int((wanted != 0).sum())


def main():
    print(f"seed {SEED}")
    random = numpy.random.default_rng(SEED)
    turn, _ = numpy.linalg.qr(random.normal(size=(3, 3)))
    turn *= numpy.sign(numpy.linalg.det(turn))
    for axes in (numpy.eye(3), turn):
        for syntax in (ExplicitVRLittleEndian, ImplicitVRLittleEndian):
            print(compare(random, axes, syntax), "voxels are the same")


main()
