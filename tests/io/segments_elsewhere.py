#!/usr/bin/env python3
"""DICOM segmentations that `burr export` writes, read by programs of others: pydicom agrees with .seg.nrrd voxel by voxel and in
its place, bits and label maps; dciodvfy finds no error; what is refused is refused in one sentence and leaves no file.

    tests/io/segments_elsewhere.py BURR         exit code 77: pydicom is not here
"""
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy
    import pydicom
except ImportError:  # the packages of Debian belong to Debian's Python
    if "again" not in sys.argv and pathlib.Path("/usr/bin/python3").exists():
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv, "again"])
    print("skipped: python3-pydicom is not installed; scripts/install_packages.sh test")
    sys.exit(77)

BURR = pathlib.Path(sys.argv[1]).resolve()
TABLE = """[[label]]
value = 1
sct = "272673000 Bone"
"""


def burr(*words, code=0):
    done = subprocess.run([BURR, "--quiet", *map(str, words)], capture_output=True, text=True)
    assert done.returncode == code, f"{words}: {done.returncode} in place of {code}: {done.stderr}"
    return done.stderr + done.stdout


def read_nrrd(path):
    """The labels (k, j, i), the step of each axis and the place of the first voxel, in mm LPS."""
    head, data = path.read_bytes().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line and ":=" not in line)
    size = [int(n) for n in fields["sizes"].split()]
    vectors = [numpy.array([float(n) for n in v.split(",")]) for v in re.findall(r"\(([^)]*)\)", fields["space directions"])]
    origin = numpy.array([float(n) for n in fields["space origin"].strip("()").split(",")])
    return numpy.frombuffer(gzip.decompress(data), numpy.uint8).reshape(size[::-1]), vectors, origin


def frames_of(file):
    """(segment number, place in mm, pixels) of each frame."""
    pixels = numpy.asarray(file.pixel_array)
    if pixels.ndim == 2:
        pixels = pixels[None]
    for group, frame in zip(file.PerFrameFunctionalGroupsSequence, pixels):
        yield (int(group.SegmentIdentificationSequence[0].ReferencedSegmentNumber),
               numpy.array([float(n) for n in group.PlanePositionSequence[0].ImagePositionPatient]), frame)


def agrees(folder, *words):
    """The same source as .dcm and as .seg.nrrd."""
    told = json.loads(burr("export", *words, "--out", folder / "a.dcm", "--json", "--force").splitlines()[-1])
    burr("export", *[w for w in words if w not in ("--segmented-by", "manual")], "--out", folder / "a.seg.nrrd", "--force")
    labels, step, origin = read_nrrd(folder / "a.seg.nrrd")
    file = pydicom.dcmread(folder / "a.dcm")
    assert file.SOPClassUID == "1.2.840.10008.5.1.4.1.1.66.4" and file.Modality == "SEG" and file.SegmentationType == "BINARY"
    assert file.SegmentsOverlap == "NO" and file.BitsAllocated == 1
    label = {one["number"]: one["label"] for one in told["segments"]}
    assert [int(s.SegmentNumber) for s in file.SegmentSequence] == list(range(1, len(label) + 1)) == sorted(label)
    shared = file.SharedFunctionalGroupsSequence[0]
    rows, columns = (float(n) for n in shared.PixelMeasuresSequence[0].PixelSpacing)
    turn = [float(n) for n in shared.PlaneOrientationSequence[0].ImageOrientationPatient]
    assert numpy.allclose(numpy.array(turn[:3]) * columns, step[0], atol=1e-6) and numpy.allclose(numpy.array(turn[3:]) * rows, step[1], atol=1e-6)
    back = numpy.zeros_like(labels)
    last = (0, -1)
    for number, place, pixels in frames_of(file):
        assert pixels.any(), "an empty frame"
        k = int(round(numpy.dot(place - origin, step[2]) / numpy.dot(step[2], step[2])))
        assert numpy.allclose(origin + k * step[2], place, atol=1e-5), (place, k)
        assert not (back[k] * pixels).any(), "segments overlap"
        assert (number, k) > last
        last = (number, k)
        back[k] += (pixels * label[number]).astype(numpy.uint8)
    assert (back == labels).all(), f"{int((back != labels).sum())} voxels differ"
    assert sum(one["voxels"] for one in told["segments"]) == int((labels != 0).sum()) > 1000
    return file


def label_map(folder, *words):
    """The same source as a binary segmentation and as a label map, by the rules of Supplement 243 and as highdicom writes them."""
    told = json.loads(burr("export", *words, "--seg-kind", "labelmap", "--out", folder / "map.dcm", "--json", "--force").splitlines()[-1])
    burr("export", *words, "--out", folder / "map.seg.nrrd", "--force")
    labels, step, origin = read_nrrd(folder / "map.seg.nrrd")
    file = pydicom.dcmread(folder / "map.dcm")
    assert file.SOPClassUID == file.file_meta.MediaStorageSOPClassUID == "1.2.840.10008.5.1.4.1.1.66.7"
    assert file.Modality == "SEG" and file.SegmentationType == "LABELMAP" and file.get("SegmentsOverlap", "NO") == "NO"
    assert (file.BitsAllocated, file.BitsStored, file.HighBit, file.PixelRepresentation, file.SamplesPerPixel) == (8, 8, 7, 0, 1)
    assert file.PhotometricInterpretation == "MONOCHROME2" and file.PixelPaddingValue == 0
    numbers = [int(s.SegmentNumber) for s in file.SegmentSequence]
    assert numbers == sorted(set(numbers)) and numbers[0] == 0 and file.SegmentSequence[0].SegmentLabel == "Background"
    assert file.SegmentSequence[0].SegmentedPropertyTypeCodeSequence[0].CodeValue == "125040"
    assert numbers[1:] == [one["number"] for one in told["segments"]] == [one["label"] for one in told["segments"]]
    # one dimension, the place of the slice; every frame at another place, evenly and without a gap
    assert [d.DimensionIndexPointer for d in file.DimensionIndexSequence] == [0x00200032] and file.DimensionOrganizationType == "3D"
    organizations = {o.DimensionOrganizationUID for o in file.DimensionOrganizationSequence}
    assert {d.DimensionOrganizationUID for d in file.DimensionIndexSequence} == organizations
    assert "SegmentIdentificationSequence" not in file.SharedFunctionalGroupsSequence[0]
    pixels = numpy.asarray(file.pixel_array).reshape(-1, file.Rows, file.Columns)
    assert len(pixels) == int(file.NumberOfFrames) == len(file.PerFrameFunctionalGroupsSequence)
    back, slices = numpy.zeros_like(labels), []
    for n, (group, frame) in enumerate(zip(file.PerFrameFunctionalGroupsSequence, pixels)):
        assert "SegmentIdentificationSequence" not in group
        assert int(numpy.atleast_1d(group.FrameContentSequence[0].DimensionIndexValues)[0]) == n + 1
        place = numpy.array([float(v) for v in group.PlanePositionSequence[0].ImagePositionPatient])
        k = int(round(numpy.dot(place - origin, step[2]) / numpy.dot(step[2], step[2])))
        assert numpy.allclose(origin + k * step[2], place, atol=1e-5), (place, k)
        slices.append(k)
        back[k] = frame
    assert slices == list(range(slices[0], slices[0] + len(slices)))
    assert (back == labels).all() and set(numpy.unique(back)) <= set(numbers), f"{int((back != labels).sum())} voxels differ"
    # burr reads it as it reads the other kind
    again = burr("export", folder / "map.dcm", "--part", "labels", "--seg-kind", "labelmap", "--out", folder / "again.dcm", "--force")
    assert (numpy.asarray(pydicom.dcmread(folder / "again.dcm").pixel_array).reshape(pixels.shape) == pixels).all(), again


def no_errors(path):
    """dciodvfy, of dicom3tools, if it is here."""
    if shutil.which("dciodvfy") is None:
        print("dciodvfy is not here (package dicom3tools): the file was not checked by it")
        return
    done = subprocess.run(["dciodvfy", path], capture_output=True, text=True)
    errors = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error")]
    assert not errors, "\n".join(errors)
    assert "SegmentationImage" in done.stdout + done.stderr or "Segmentation" in done.stdout + done.stderr


def refuses(folder):
    (folder / "no.toml").write_text('[[label]]\nvalue = 1\nsct = "91609007 Mandible"\n')
    ball = folder / "ball.seg.nrrd"
    burr("export", "phantom:ball", "--out", ball, "--force")
    grey = folder / "grey.nrrd"
    burr("export", "phantom:ball", "--out", grey, "--force")
    out = folder / "no.dcm"
    for words, code, said in (
            (["phantom:ball", "--out", folder / "no.stl", "--no-patient"], 2, "are for a DICOM segmentation"),
            (["phantom:ball", "--out", folder / "no.stl", "--seg-kind", "labelmap"], 2, "are for a DICOM segmentation"),
            (["phantom:ball", "--out", folder / "no.stl", "--part", "labels"], 2, "--part labels writes the labels of a file as DICOM"),
            (["phantom:ball", "--out", out, "--part", "labels"], 2, "a phantom is bone from the start"),
            (["phantom:ball", "--out", out, "--part", "pieces"], 2, "DICOM holds all segments in one"),
            (["phantom:ball", "--out", out, "--frame", "ras"], 2, "the frame can be chosen only for"),
            (["phantom:ball", "--out", out, "--uid-root", "mine"], 2, "--uid-root: mine is no root of UIDs"),
            (["phantom:ball", "--out", out, "--part", "removed"], 2, "nothing has been removed"),
            ([grey, "--out", out, "--part", "labels"], 65, "is a grey scan, which has no labels"),
            ([ball, "--out", out, "--tissues", folder / "no.toml"], 65, "check digit"),
            ([ball, "--out", out, "--tissues", folder], 2, "is a folder and no table of labels"),
            ([ball, "--out", out, "--study-of", grey], 65, "belongs to no study"),
            ([ball, "--out", folder / "none" / "no.dcm"], 74, "does not exist"),
    ):
        text = burr("export", *words, code=code)
        assert said in text, f"{words}: {text}"
        assert not out.exists() and not list(folder.glob("*.part*")), "a file was left behind"
    # what is there stays: a slice of somebody's scan, and a file that is no DICOM
    burr("export", ball, "--out", out)
    kept = out.read_bytes()
    assert "exists" in burr("export", ball, "--out", out, code=2) and out.read_bytes() == kept
    out.write_bytes(b"no DICOM at all" * 20)
    assert "is not a .dcm file" in burr("export", ball, "--out", out, "--force", code=2)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        file = agrees(folder, "phantom:tooth", "--segmented-by", "manual")
        assert {s.SegmentAlgorithmType for s in file.SegmentSequence} == {"MANUAL"} and file.PatientName == ""
        no_errors(folder / "a.dcm")
        label_map(folder, "phantom:tooth")
        # labels in, labels out, with a code
        (folder / "t.toml").write_text(TABLE)
        burr("export", "phantom:ball", "--out", folder / "ball.seg.nrrd")
        file = agrees(folder, folder / "ball.seg.nrrd", "--tissues", folder / "t.toml")
        segment = file.SegmentSequence[0]
        assert segment.SegmentedPropertyTypeCodeSequence[0].CodeValue == "272673000", segment
        assert segment.SegmentAlgorithmType == "SEMIAUTOMATIC" and segment.SegmentAlgorithmName.startswith("burr ")
        no_errors(folder / "a.dcm")
        # into the study of a scan: that of the first file, where it was written
        study = file.StudyInstanceUID
        text = burr("export", folder / "ball.seg.nrrd", "--part", "labels", "--study-of", folder / "a.dcm", "--out", folder / "b.dcm")
        second = pydicom.dcmread(folder / "b.dcm")
        assert second.StudyInstanceUID == study and second.FrameOfReferenceUID == file.FrameOfReferenceUID, text
        assert second.SeriesInstanceUID != file.SeriesInstanceUID and second.SOPInstanceUID != file.SOPInstanceUID
        burr("export", folder / "ball.seg.nrrd", "--part", "labels", "--study-of", folder / "a.dcm", "--no-patient", "--out", folder / "c.dcm")
        assert pydicom.dcmread(folder / "c.dcm").StudyInstanceUID != study
        refuses(folder)
    print("pydicom agrees")


main()
