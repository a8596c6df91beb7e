"""Data sets: `burr export --part dataset` read by h5py and h5dump, and burr.dataset.from_recordings."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

import burr
import burr.dataset
import burr.env

try:
    import h5py
except ImportError:  # scripts/packages.txt names python3-h5py
    h5py = None

BURR = os.environ["BURR_PROGRAM"]
VOXELS = "physics_data/intermittent_data/voxels_removed"
ADDED = "physics_data/intermittent_data/voxels_added"
SIGHT = "vision_data/continuous_data"
POSES = "physics_data/continuous_data/high_frequency_poses"


def box(voxel_mm=0.25):
    """A block of bone of 10 x 8 x 5 mm in air, its top at z = 2.5 mm; one quarter of it has another label."""
    half = np.array([2.5, 4.0, 5.0]) / voxel_mm  # z, y, x [voxel]
    shape = [int(2 * h) + 12 for h in half]
    away = [np.abs(np.arange(n) - (n - 1) / 2) for n in shape]
    depth = np.minimum(np.minimum((half[0] - away[0])[:, None, None], (half[1] - away[1])[None, :, None]),
                       (half[2] - away[2])[None, None, :])
    field = np.clip(32768 + depth * 16384, 0, 65535).astype(np.uint16)
    labels = np.ones(shape, np.uint8)
    labels[:, : shape[1] // 2, : shape[2] // 2] = 2
    tissues = [burr.Tissue("air", kind="air"), burr.Tissue("bone", colour=(0.9, 0.8, 0.6)),
               burr.Tissue("hard bone", colour=(0.2, 0.4, 1.0), spare=True)]
    origin = [-voxel_mm * (n - 1) / 2 for n in reversed(shape)]
    return burr.Bone.from_array(field, voxel_mm, labels=labels, tissues=tissues, origin_mm=origin)


def leaning(angle=0.8):
    return (np.cos(angle / 2), np.sin(angle / 2), 0, 0)


def record(file, undo=False):
    """A session that rubs over both labels and changes its burr; voxels as the session itself found them."""
    scene = burr.Scene(box(), burr_mm=3)
    scene.undo_bricks = 512
    with scene.session(record=str(file)) as session:
        session.hand((-3e-3, -1e-3, 7e-3), leaning(), 1, ticks=0)
        session.step(600)
        for n in range(4):
            session.hand((3e-3 * (-1) ** n, -1e-3 + 0.3e-3 * n, 2.8e-3 - 0.1e-3 * n), ticks=500)
            session.step(500)
        session.hand((0, 1e-3, 8e-3), ticks=200)
        session.step(200)
        session.set_burr_mm(4)
        session.hand((0, 1e-3, 2.6e-3), ticks=400)
        session.step(600)
        if undo:
            session.hand((0, 1e-3, 9e-3), pedal=0, ticks=150)
            session.step(200)
            session.undo()
            session.step(200)
        return session.removed(), session.added()


def export(recording, out, *more):
    done = subprocess.run([BURR, "--quiet", "export", str(recording), "--part", "dataset", "--out", str(out), "--json", *more],
                          capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout.splitlines()[-1])


def rotation(q):
    """Of a quaternion x y z w."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def matrix(pose):
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = rotation(pose[3:]), pose[:3]
    return made


class Project:
    """Points of the world in the pictures of one sample, by what the file says about itself."""

    def __init__(self, file, sample, aside=0.0):
        meta = file["metadata_v3"]
        self.k = meta["camera_intrinsic"][()]
        to_camera = np.linalg.inv(matrix(file[SIGHT]["pose_main_camera"][sample]))
        self.to_cv = meta["camera_extrinsic"][()] @ to_camera
        self.aside = aside  # of the eye, to its right [m]

    def camera(self, points):
        points = np.atleast_2d(points)
        made = (self.to_cv @ np.concatenate((points, np.ones((len(points), 1))), axis=1).T).T[:, :3]
        return made - (self.aside, 0, 0)

    def __call__(self, points):
        p = self.camera(points) @ self.k.T
        return p[:, :2] / p[:, 2:]

    def world(self, u, v, depth):
        p = np.stack(((u - self.k[0, 2]) / self.k[0, 0], (v - self.k[1, 2]) / self.k[1, 1], np.ones_like(u)), axis=-1)
        p = p * depth[..., None] + (self.aside, 0, 0)
        back = np.linalg.inv(self.to_cv)
        return p @ back[:3, :3].T + back[:3, 3]


def inside_hull(points, width, height):
    """Which pixels' middles lie in the convex outline of some points of the picture."""
    points = sorted(map(tuple, points))

    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1 and (chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1]) <= (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0]):
                chain.pop()
            chain.append(p)
        return chain[:-1]
    outline = half(points) + half(reversed(points))
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    inside = np.ones((height, width), bool)
    for (x0, y0), (x1, y1) in zip(outline, outline[1:] + outline[:1]):
        inside &= (x1 - x0) * (v - y0) - (y1 - y0) * (u - x0) >= 0
    return inside


def grown(mask, by):
    made = mask.copy()
    for dy in range(-by, by + 1):
        for dx in range(-by, by + 1):
            made |= np.roll(np.roll(mask, dy, 0), dx, 1)
    return made


class Folder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()


@unittest.skipIf(h5py is None, "h5py is missing: apt-get install python3-h5py")
class Export(Folder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "s.mcap"
        cls.removed, cls.added = record(cls.file)
        cls.told = export(cls.file, cls.folder / "s.hdf5")
        cls.recording = burr.Recording(str(cls.file))

    def opened(self, name="s.hdf5"):
        file = h5py.File(self.folder / name, "r")
        self.addCleanup(file.close)
        return file

    def test_the_structure_is_that_of_layout_3(self):
        file = self.opened()
        for name in ("metadata_v3", "vision_data", "physics_data"):
            self.assertIn(name, file)
            self.assertIsInstance(file[name], h5py.Group)
        for part in ("vision_data", "physics_data"):
            for name in ("intermittent_data", "continuous_data"):
                self.assertIsInstance(file[part][name], h5py.Group)
        for name in ("voxels_removed", "burr_change", "drill_force_feedback"):
            self.assertIn(name, file["physics_data/intermittent_data"])
        self.assertEqual(set(file["metadata_v3"]) & {"camera_intrinsic", "camera_extrinsic", "voxel_volume", "baseline", "README"},
                         {"camera_intrinsic", "camera_extrinsic", "voxel_volume", "baseline", "README"})
        self.assertEqual(len(file["vision_data/intermittent_data"]), 0)
        ticks, samples = len(self.recording), self.told["samples"]
        self.assertEqual(samples, -(-ticks // 20))
        for name in ("drill_pose", "camera_pose", "anatomy_pose"):
            self.assertEqual(file[f"{POSES}/{name}/pose"].shape, (ticks, 7))
            self.assertEqual(file[f"{POSES}/{name}/time_stamp"].shape, (ticks,))
        for name in ("pose_mastoidectomy_drill", "pose_main_camera", "pose_mastoidectomy_volume"):
            self.assertEqual(file[f"{SIGHT}/{name}"].shape, (samples, 7))
        self.assertEqual(file[f"{SIGHT}/time"].shape, (samples,))
        self.assertEqual(file["physics_data/intermittent_data/drill_force_feedback/wrench"].shape, (ticks, 6))
        for absent in ("l_img", "r_img", "depth", "segm"):
            self.assertNotIn(absent, file[SIGHT])

    def test_the_metadata(self):
        meta = self.opened()["metadata_v3"]
        self.assertAlmostEqual(meta["voxel_volume"][()], 0.25 ** 3, places=12)
        self.assertEqual(meta["voxel_volume"].attrs["units"], "mm^3")
        np.testing.assert_array_equal(meta["camera_extrinsic"], [[0, 1, 0, 0], [0, 0, -1, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
        k = meta["camera_intrinsic"][()]
        self.assertEqual((k[0, 0], k[0, 2], k[1, 2]), (k[1, 1], 320, 240))
        readme = meta["README"][()].decode()
        for word in ("LPS", "metres", "x y z w", "What is lost", "half of it is left", "torque", "seconds since the first tick"):
            self.assertIn(word, readme)
        self.assertEqual([name.decode() for name in meta["label_names"]], ["air", "bone", "hard bone"])
        np.testing.assert_array_equal(meta["label_colors"][2], (51, 102, 255))

    def test_poses_and_forces_are_those_of_the_recording(self):
        file, rows = self.opened(), self.recording.ticks
        drill = file[f"{POSES}/drill_pose/pose"][()]
        np.testing.assert_allclose(drill[:, :3], rows["hand_m"], rtol=0, atol=1e-9)
        np.testing.assert_allclose(drill[:, 3:], np.roll(rows["hand_q"], -1, axis=1), rtol=0, atol=1e-9)
        np.testing.assert_allclose(file[f"{POSES}/drill_pose/time_stamp"], rows["tick"] / 1000, rtol=0, atol=1e-12)
        np.testing.assert_allclose(file[f"{POSES}/proxy_pose/pose"][:, :3], rows["proxy_m"], rtol=0, atol=1e-9)
        wrench = file["physics_data/intermittent_data/drill_force_feedback/wrench"][()]
        np.testing.assert_array_equal(wrench, np.concatenate((rows["force_n"], rows["torque_nm"]), axis=1))
        self.assertGreater(np.abs(wrench[:, :3]).max(), 0.1)
        sample = file[f"{SIGHT}/pose_mastoidectomy_drill"][()]
        np.testing.assert_array_equal(sample, drill[::20])
        np.testing.assert_array_equal(file[f"{SIGHT}/time"], file[f"{POSES}/drill_pose/time_stamp"][::20])

    def test_the_volume_lies_where_its_pose_says(self):
        file, bone = self.opened(), self.recording.before()
        pose = matrix(file[f"{POSES}/anatomy_pose/pose"][7])
        size, voxel = file["metadata_v3/volume_size"][()], file["metadata_v3/voxel_size"][()]
        np.testing.assert_array_equal(size, bone.shape[::-1])
        ijk = np.array([[0, 0, 0], [5, 9, 3], [40, 11, 20]])
        there = (pose[:3, :3] @ (voxel * (ijk + 0.5 - size / 2)).T).T + pose[:3, 3]
        np.testing.assert_allclose(there, bone.world_from_index(ijk), rtol=0, atol=1e-9)

    def check_voxels(self, group, crossed):
        """The first column is the row of the group; times and places are those that the session itself saw."""
        name = "voxel_removed" if "voxel_removed" in group else "voxel_added"
        voxels, colours, times = group[name][()], group["voxel_color"][()], group["voxel_time_stamp"][()]
        self.assertEqual(voxels.shape, (len(crossed), 4))
        self.assertEqual(colours.shape, (len(crossed), 5))
        np.testing.assert_array_equal(voxels[:, 0], colours[:, 0])
        if len(voxels):
            np.testing.assert_array_equal(np.unique(voxels[:, 0]), np.arange(len(times)))  # no group is empty
            self.assertTrue(np.all(np.diff(voxels[:, 0]) >= 0))
        self.assertTrue(np.all(np.diff(times) > 0))
        found = np.concatenate((np.rint(1000 * times[voxels[:, 0]])[:, None].astype(int), voxels[:, 1:]), axis=1)
        self.assertEqual(sorted(map(tuple, found)), sorted(map(tuple, crossed)))
        labels = self.recording.before().labels()[voxels[:, 3], voxels[:, 2], voxels[:, 1]]
        table = {1: (230, 204, 153, 255), 2: (51, 102, 255, 255)}
        self.assertEqual([tuple(c) for c in colours[:, 1:]], [table[label] for label in labels])
        return labels

    def test_voxels_are_those_that_crossed(self):
        labels = self.check_voxels(self.opened()[VOXELS], self.removed)
        self.assertEqual(set(labels), {1, 2})
        self.assertGreater(len(labels), 200)
        self.assertEqual(len(self.opened()[ADDED]["voxel_added"]), 0)

    def test_their_number_is_the_difference_of_the_bones(self):
        before, after = self.recording.before().field() >= 32768, self.recording.bone().field() >= 32768
        gone = np.argwhere(before & ~after)[:, ::-1]  # i, j, k
        voxels = self.opened()[VOXELS]["voxel_removed"][:, 1:]
        self.assertEqual(sorted(map(tuple, voxels)), sorted(map(tuple, gone)))
        self.assertEqual(self.told["voxels_removed"], len(gone))
        self.assertFalse(np.any(after & ~before))
        # the exact volume is another: parts of voxels count in it
        exact = self.recording["removed_m3"][-1] * 1e9
        self.assertAlmostEqual(len(gone) * 0.25 ** 3 / exact, 1, delta=0.15)

    def test_burr_changes(self):
        group = self.opened()["physics_data/intermittent_data/burr_change"]
        np.testing.assert_allclose(group["burr_size"], (3, 4))
        radius = self.recording["tool_radius_m"]
        np.testing.assert_allclose(group["time_stamp"], (0, np.argmax(radius > 1.9e-3) / 1000))

    def test_what_came_back_is_told(self):
        removed, added = record(self.folder / "u.mcap", undo=True)
        self.assertGreater(len(added), 50)
        told = export(self.folder / "u.mcap", self.folder / "u.hdf5")
        file = self.opened("u.hdf5")
        recording, self.recording = self.recording, burr.Recording(str(self.folder / "u.mcap"))
        self.check_voxels(file[VOXELS], removed)
        self.check_voxels(file[ADDED], added)
        inside = [int(np.count_nonzero(bone.field() >= 32768)) for bone in (self.recording.before(), self.recording.bone())]
        self.recording = recording
        self.assertEqual(told["voxels_removed"] - told["voxels_added"], inside[0] - inside[1])

    def test_chunks_hold_together_what_one_file_holds(self):
        told = export(self.file, self.folder / "c.hdf5", "--chunk", "21", "--begins", "1700000000")
        files = told["files"]
        self.assertEqual([pathlib.Path(name).name for name in files], [f"c_{n:05}.hdf5" for n in range(1, len(files) + 1)])
        self.assertEqual(len(files), -(-told["samples"] // 21))
        self.assertEqual(sorted(files), files)
        whole, parts = self.opened(), [self.opened(pathlib.Path(name).name) for name in files]
        for name in (f"{POSES}/drill_pose/pose", f"{SIGHT}/pose_main_camera", "physics_data/intermittent_data/drill_force_feedback/wrench"):
            np.testing.assert_array_equal(np.concatenate([part[name] for part in parts]), whole[name])
        for name in (f"{SIGHT}/time", f"{VOXELS}/voxel_time_stamp", f"{POSES}/camera_pose/time_stamp"):
            np.testing.assert_allclose(np.concatenate([part[name] for part in parts]) - 1.7e9, whole[name], rtol=0, atol=1e-6)
        np.testing.assert_array_equal(np.concatenate([part[VOXELS]["voxel_removed"][:, 1:] for part in parts]),
                                      whole[VOXELS]["voxel_removed"][:, 1:])
        self.assertGreater(sum(len(part[VOXELS]["voxel_time_stamp"]) > 0 for part in parts), 2)
        for part in parts:
            self.assertLessEqual(len(part[f"{SIGHT}/time"]), 21)
            rows = part[VOXELS]["voxel_removed"][:, 0]
            np.testing.assert_array_equal(np.unique(rows), np.arange(len(part[VOXELS]["voxel_time_stamp"])))  # begins at 0 again
            times = part[VOXELS]["voxel_time_stamp"][()]
            ticks = part[f"{POSES}/drill_pose/time_stamp"][()]
            self.assertTrue(np.all((times >= ticks[0]) & (times <= ticks[-1])))
            self.assertEqual(len(part["physics_data/intermittent_data/burr_change/burr_size"]) > 0, True)
        self.assertIn("1970", parts[0]["metadata_v3/README"][()].decode())

    def test_layout_2_finds_the_same_by_its_own_names(self):
        export(self.file, self.folder / "old.hdf5", "--layout", "2")
        file = self.opened("old.hdf5")
        for old, new in (("metadata/camera_intrinsic", "metadata_v3/camera_intrinsic"), ("data/pose_main_camera", f"{SIGHT}/pose_main_camera"),
                         ("voxels_removed/voxel_color", f"{VOXELS}/voxel_color"), ("burr_change/burr_size", "physics_data/intermittent_data/burr_change/burr_size"),
                         ("drill_force_feedback/wrench", "physics_data/intermittent_data/drill_force_feedback/wrench"),
                         ("high_frequency_poses/drill_pose/pose", f"{POSES}/drill_pose/pose")):
            self.assertEqual(file[old], file[new])
        self.assertNotIn("data", self.opened())
        self.assertIsInstance(file.get("data", getlink=True), h5py.SoftLink)

    def test_equal_recordings_give_equal_bytes(self):
        export(self.file, self.folder / "again.h5")
        self.assertEqual((self.folder / "again.h5").read_bytes(), (self.folder / "s.hdf5").read_bytes())

    def test_old_readers_can_open_it(self):
        data = (self.folder / "s.hdf5").read_bytes()
        self.assertEqual(data[:8], b"\x89HDF\r\n\x1a\n")
        self.assertEqual(data[8], 0)  # superblock of HDF5 1.0 to 1.8
        if not shutil.which("h5dump"):
            self.skipTest("h5dump is missing: apt-get install hdf5-tools")
        head = subprocess.run(["h5dump", "-H", str(self.folder / "s.hdf5")], capture_output=True, text=True, check=True).stdout
        self.assertIn('DATASET "voxel_removed"', head)
        self.assertIn(f"SIMPLE {{ ( {len(self.removed)}, 4 ) / ( H5S_UNLIMITED, 4 ) }}", head)

    def test_refusals_say_what_to_do(self):
        for arguments, sentence in (((self.file, "--part", "bone", "--out", "b.stl", "--chunk", "3"), "--chunk: is of --part dataset only"),
                                    (("phantom:block", "--part", "dataset", "--out", "b.hdf5"), "give a recording (.mcap)"),
                                    ((self.file, "--part", "dataset", "--out", "b.stl"), "must end in .hdf5 or .h5"),
                                    ((self.file, "--part", "dataset", "--out", "b.hdf5", "--at", "1"), "a data set holds the whole recording"),
                                    ((self.file, "--part", "dataset", "--out", "b.hdf5", "--images", "640"), "such as 640x480"),
                                    ((self.file, "--part", "dataset", "--out", "no/b.hdf5"), "does not exist")):
            done = subprocess.run([BURR, "--quiet", "export", *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(sentence, done.stderr)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("b.") or name.endswith(".part")], [])

    def test_a_recorded_view_is_the_camera(self):
        subprocess.run([BURR, "--quiet", "run", "block", "--headless", "--seconds", "1", "--out", str(self.folder / "run")],
                       check=True, capture_output=True)
        export(self.folder / "run" / "session.mcap", self.folder / "run.hdf5")
        file = self.opened("run.hdf5")
        self.assertIn("the one of the recorded session", file["metadata_v3/README"][()].decode())
        self.assertIn("at rest", self.opened()["metadata_v3/README"][()].decode())
        cv = Project(file, 0)
        # the work lies ahead, in the middle
        place = burr.Scene("block").at_m
        u, v = cv(place)[0]
        self.assertAlmostEqual(u, 320, delta=40)
        self.assertAlmostEqual(v, 240, delta=40)
        self.assertGreater(cv.camera(place)[0, 2], 0.01)


WIDTH, HEIGHT = 200, 150


@unittest.skipIf(h5py is None, "h5py is missing: apt-get install python3-h5py")
class Pictures(Folder):
    BASELINE = 6e-3

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        record(cls.folder / "s.mcap")
        cls.told = export(cls.folder / "s.mcap", cls.folder / "s.hdf5", "--images", f"{WIDTH}x{HEIGHT}", "--fps", "4", "--baseline-mm", "6")
        cls.recording = burr.Recording(str(cls.folder / "s.mcap"))
        cls.file = h5py.File(cls.folder / "s.hdf5", "r")
        cls.last = cls.told["samples"] - 1

    @classmethod
    def tearDownClass(cls):
        cls.file.close()
        super().tearDownClass()

    def picture(self, name, sample):
        return self.file[SIGHT][name][sample]

    def corners(self):
        return np.array([[x, y, z] for x in (-5e-3, 5e-3) for y in (-4e-3, 4e-3) for z in (-2.5e-3, 2.5e-3)])

    def test_shapes_and_types(self):
        samples = self.told["samples"]
        self.assertEqual(samples, -(-len(self.recording) * 4 // 1000))
        for name in ("l_img", "r_img", "segm"):
            self.assertEqual((self.file[SIGHT][name].shape, self.file[SIGHT][name].dtype), ((samples, HEIGHT, WIDTH, 3), np.uint8))
        self.assertEqual((self.file[SIGHT]["depth"].shape, self.file[SIGHT]["depth"].dtype), ((samples, HEIGHT, WIDTH), np.float16))
        self.assertAlmostEqual(self.file["metadata_v3/baseline"][()], self.BASELINE)
        self.assertEqual(self.file["metadata_v3/camera_intrinsic"][0, 2], WIDTH / 2)

    def test_labels_have_the_colours_of_the_table(self):
        seen = {tuple(c) for c in self.picture("segm", self.last).reshape(-1, 3)}
        blue_first = {tuple(int(c) for c in reversed(row)) for row in self.file["metadata_v3/label_colors"][1:]}
        self.assertEqual(seen, blue_first | {(0, 0, 0), (255, 255, 255)})

    def test_the_tip_is_where_matrices_put_it(self):
        for sample in range(self.told["samples"]):
            tip = self.file[SIGHT]["pose_mastoidectomy_proxy"][sample, :3]
            project = Project(self.file, sample)
            (u, v), c = project(tip)[0], project.camera(tip)[0]
            if not (2 < u < WIDTH - 2 and 2 < v < HEIGHT - 2):
                continue
            radius = self.recording["tool_radius_m"][min(250 * sample, len(self.recording) - 1)]
            depth = float(self.picture("depth", sample)[int(v), int(u)])
            self.assertEqual(tuple(self.picture("segm", sample)[int(v), int(u)]), (255, 255, 255))  # the tool
            # the ray to the tip meets the head's front, or the shaft before it
            self.assertLess(depth, c[2] * (1 - radius / np.linalg.norm(c)) + 0.2e-3)
            self.assertGreater(depth, c[2] - 3 * radius)
            break
        else:
            self.fail("the tip is in no picture")

    def test_depth_is_the_bone(self):
        """What is seen of the bone, put back into the world, lies on the bone's surface at that moment."""
        checked = 0
        for sample in (0, self.last):
            bone = self.recording.bone(0.25 * sample)
            depth, labels = self.picture("depth", sample).astype(np.float64), self.picture("segm", sample)
            v, u = np.nonzero(np.isfinite(depth) & np.any(labels != 255, axis=2) & np.any(labels != 0, axis=2))
            world = Project(self.file, sample).world(u + 0.5, v + 0.5, depth[v, u])
            field = bone.field().astype(np.float64)
            at = bone.index_from_world(world)
            low = np.clip(np.floor(at).astype(int), 0, np.array(bone.shape[::-1]) - 2)
            share = at - low
            value = np.zeros(len(at))
            for corner in np.ndindex(2, 2, 2):
                weight = np.prod(np.where(np.array(corner), share, 1 - share), axis=1)
                i, j, k = (low + corner).T
                value += weight * field[k, j, i]
            off_mm = np.abs(value - 32768) / 16384 * 0.25
            self.assertLess(np.median(off_mm), 0.05)
            self.assertLess(np.quantile(off_mm, 0.97), 0.15)
            # the label of a pixel is that of a voxel beside it
            table = {tuple(int(c) for c in reversed(row)): n for n, row in enumerate(self.file["metadata_v3/label_colors"][()])}
            i, j, k = np.rint(at).astype(int).T
            same = [table[tuple(c)] == label for c, label in zip(labels[v, u], bone.labels()[k, j, i])]
            self.assertGreater(np.mean(same), 0.97)
            checked += len(v)
        self.assertGreater(checked, 2000)

    def test_both_eyes_see_the_block_where_matrices_put_it(self):
        scene = burr.Scene(box(), burr_mm=3)
        with scene.session(record=str(self.folder / "far.mcap")) as session:
            session.hand((80e-3, 0, 30e-3), ticks=0)  # the tool is not in the picture
            session.step(100)
            session.hand((0, 0, 5e-3), ticks=0)  # where the camera looks
            session.step(10)
        export(self.folder / "far.mcap", self.folder / "far.hdf5", "--images", f"{WIDTH}x{HEIGHT}", "--fps", "1", "--baseline-mm", "6")
        with h5py.File(self.folder / "far.hdf5", "r") as file:
            eyes = {name: (Project(file, 0, aside), file[SIGHT][name][0].astype(int))
                    for name, aside in (("l_img", -self.BASELINE / 2), ("r_img", self.BASELINE / 2))}
            middle = inside_hull(Project(file, 0)(self.corners()), WIDTH, HEIGHT)
            labels = np.any(file[SIGHT]["segm"][0] != 0, axis=2)
            np.testing.assert_array_equal(labels, np.isfinite(file[SIGHT]["depth"][0]))
        self.assertGreater(np.count_nonzero(middle), 2000)
        self.assertLess(np.count_nonzero(labels != middle), 0.05 * np.count_nonzero(middle))
        for name, (project, picture) in eyes.items():
            expected = inside_hull(project(self.corners()), WIDTH, HEIGHT)
            seen = picture.max(axis=2) > 85  # the background is darker
            judged = ~(grown(expected, 2) & grown(~expected, 2))  # beside the outline anything may be
            self.assertGreater(np.mean(seen[judged & expected]), 0.99, name)
            self.assertLess(np.mean(seen[judged & ~expected]), 0.01, name)
            # the outline is not that of the camera in the middle
            self.assertGreater(np.count_nonzero(seen != middle), 3 * np.count_nonzero(seen != expected))


class FromRecordings(Folder):
    @staticmethod
    def scene():
        scene = burr.Scene(box(), burr_mm=3)
        scene.undo_bricks = 512
        return scene

    def episode(self, name, steps=40):
        """What an environment saw and did, in a session that was recorded."""
        env = burr.env.Env(self.scene(), max_steps=steps + 1, end_on_injury=False)
        env.session = env.task.scene.session(record=str(self.folder / name))
        observation, _ = env.reset(seed=5)
        random = np.random.default_rng(2)
        seen, done = [], []
        for n in range(steps):
            action = np.array([*(0.25e-3 * env.task.into + random.uniform(-0.2e-3, 0.2e-3, 3)), *random.uniform(-0.02, 0.02, 3), n % 2], np.float32)
            seen.append(observation)
            done.append(action)
            observation, *_ = env.step(action)
        env.close()
        return seen, done

    def test_an_episode_comes_back(self):
        seen, done = self.episode("e.mcap")
        shown = burr.dataset.from_recordings(str(self.folder / "e.mcap"), check=True)
        self.assertEqual(len(shown), len(done))
        self.assertEqual(shown.structures, ["hard bone"])
        env = burr.env.Env(self.scene())
        for n, (observation, action) in enumerate(shown):
            self.assertEqual(observation.keys(), seen[n].keys())
            for key, value in observation.items():
                np.testing.assert_array_equal(value, seen[n][key], key)
            np.testing.assert_allclose(action, done[n], rtol=0, atol=2e-6)
            self.assertTrue(env.observation_space.contains(observation))
            self.assertTrue(env.action_space.contains(action))
        self.assertFalse(shown.clipped.any())
        self.assertGreater(np.abs(shown.observations["force"]).max(), 0.05)
        np.testing.assert_array_equal(shown.tick, 599 + 20 * np.arange(len(done)))
        env.close()

    def test_several_sessions_are_kept_apart(self):
        for name in ("a1.mcap", "a2.mcap"):
            self.episode(name, 10)
        shown = burr.dataset.from_recordings(self.folder / "a*.mcap")
        self.assertEqual([pathlib.Path(file).name for file in shown.files], ["a1.mcap", "a2.mcap"])
        np.testing.assert_array_equal(shown.recording, [0] * 10 + [1] * 10)
        observation, action = shown[10]
        self.assertEqual((observation["pose"].shape, action.shape), ((7,), (7,)))

    def test_what_an_action_may_not_is_shortened_and_marked(self):
        with self.scene().session(record=str(self.folder / "fast.mcap")) as session:
            session.hand((0, 0, 8e-3), ticks=0)
            session.step(620)
            session.hand((3e-3, 0, 8e-3), ticks=60)  # 1 mm a step
            session.step(60)
            session.hand((3e-3, 0, 8e-3), ticks=40)
            session.step(40)
        shown = burr.dataset.from_recordings([str(self.folder / "fast.mcap")])
        np.testing.assert_array_equal(shown.clipped, [False, True, True, True, False, False])
        np.testing.assert_allclose(shown.actions[1:4, 0], burr.env.MOST_MOVE_M)
        self.assertEqual(shown.actions.dtype, np.float32)

    def test_steps_with_a_lifted_hand_are_left_out(self):
        with self.scene().session(record=str(self.folder / "lifted.mcap")) as session:
            session.hand((0, 0, 8e-3), ticks=0)
            session.step(605)
            for buttons, ticks in ((0, 40), (burr.dataset.LIFTED, 10), (0, 100)):  # ticks 645 to 654
                session.hand((0, 0, 8e-3), buttons=buttons, ticks=1)
                session.step(ticks)
        shown = burr.dataset.from_recordings(self.folder / "lifted.mcap")
        # steps begin at 599, 619 ...: that from 639 to 659 is left out
        np.testing.assert_array_equal(shown.tick, [599, 619, 659, 679, 699, 719])

    def test_refusals(self):
        with self.assertRaisesRegex(burr.Error, "no file has such a name"):
            burr.dataset.from_recordings(str(self.folder / "none*.mcap"))
        with self.assertRaisesRegex(burr.Error, "is empty"):
            burr.dataset.from_recordings([])
        with self.assertRaisesRegex(burr.Error, "at least one tick"):
            burr.dataset.from_recordings(["x.mcap"], ticks=0)
        self.episode("m1.mcap", 3)
        bare = burr.Scene("phantom:block", burr_mm=4)
        with bare.session(record=str(self.folder / "m2.mcap")) as session:
            session.hand(bare.at_m - 5e-3 * bare.into, ticks=0)
            session.step(700)
        with self.assertRaisesRegex(burr.Error, "take recordings of one case"):
            burr.dataset.from_recordings(str(self.folder / "m?.mcap"))

    def test_a_short_recording_gives_nothing(self):
        with self.scene().session(record=str(self.folder / "short.mcap")) as session:
            session.hand((0, 0, 8e-3), ticks=0)
            session.step(610)
        shown = burr.dataset.from_recordings([str(self.folder / "short.mcap")])
        self.assertEqual((len(shown), shown.actions.shape, shown.observations["near"].shape), (0, (0, 7), (0, 1)))

    def test_turns_about_any_axis(self):
        random = np.random.default_rng(4)
        for angle in (0, 1e-9, 1e-3, 0.5, 3.1):
            q = random.normal(size=(20, 4))
            q /= np.linalg.norm(q, axis=1, keepdims=True)
            axis = random.normal(size=(20, 3))
            axis /= np.linalg.norm(axis, axis=1, keepdims=True)
            after = np.array([burr.env._turned(tuple(a), *(angle * b)) for a, b in zip(q, axis)])
            after *= np.where(np.arange(20) % 2, 1, -1)[:, None]  # the same rotation
            np.testing.assert_allclose(burr.dataset._turns(q, after), angle * axis, atol=1e-9)


if __name__ == "__main__":
    unittest.main()
