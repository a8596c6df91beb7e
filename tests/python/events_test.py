"""Functions that are told what happens in a session. No test here depends on how fast anything is."""
import gc
import math
import os
import subprocess
import sys
import threading
import time
import unittest
import weakref

import numpy as np

import burr


def plate(edge=40):
    """A plate of bone with a soft nerve 1 mm below its surface, at z = 0."""
    depth = (edge / 2 - 0.5) - np.arange(edge)
    field = np.ascontiguousarray(np.broadcast_to(np.clip(32768 + depth * 16384, 0, 65535).astype(np.uint16)[:, None, None], (edge,) * 3))
    labels = np.ones((edge,) * 3, np.uint8)
    labels[14:17, :, 18:22] = 2
    field[14:17, :, 18:22] = 0
    labels[:, :10] = 3
    tissues = [burr.Tissue("air", kind="air"), burr.Tissue("bone"), burr.Tissue("nerve", kind="soft", spare=True), burr.Tissue("far bone")]
    return burr.Bone.from_array(field, 0.25, labels=labels, tissues=tissues, origin_mm=(-4.875,) * 3)


def scene(**more):
    made = burr.Scene(plate(), burr_mm=3, **more)
    made.undo_bricks = 256
    return made


def lean(angle=1.0):
    return (math.cos(angle / 2), math.sin(angle / 2), 0, 0)


def taps(session, count):
    """The burr goes into the bone's surface and out again, without turning."""
    session.hand((0, 0, 4e-3), lean(), 0, ticks=0)
    session.step(600)
    for _ in range(count):
        session.hand((0, 0, 1.2e-3), ticks=100)
        session.step(100)
        session.hand((0, 0, 4e-3), ticks=100)
        session.step(100)


def edges(rows):
    """Numbers of the ticks in which a touch begins, and in which it ends."""
    touching = np.concatenate(([False], rows["touching"]))
    turns = np.flatnonzero(touching[1:] != touching[:-1])
    return turns[touching[1:][turns]], turns[~touching[1:][turns]]


class Events(unittest.TestCase):
    def test_touch_and_leave_are_those_of_the_rows(self):
        seen = []
        with scene().session() as session:
            session.on("touch", seen.append)
            session.on("leave", seen.append)
            taps(session, 5)
            rows = session.rows()
        begins, ends = edges(rows)
        self.assertGreaterEqual(len(begins), 5)
        for name, ticks in (("touch", begins), ("leave", ends)):
            mine = [event for event in seen if event.event == name]
            self.assertEqual(sum(event.count for event in mine), len(ticks))
            self.assertEqual(mine[0].first_tick, ticks[0])
            self.assertEqual(mine[-1].tick, ticks[-1])
            np.testing.assert_array_equal(mine[-1].p_m, rows["proxy_m"][ticks[-1]])
            self.assertIn(name, repr(mine[0]))

    def test_what_comes_late_is_merged(self):
        entered, go_on, seen = threading.Event(), threading.Event(), []

        def slow(event):
            seen.append((event.first_tick, event.tick, event.count))
            entered.set()
            go_on.wait()
        session = scene().session()
        session.on("touch", slow)
        taps(session, 1)
        entered.wait()  # the helper thread is in the function
        begins, _ = edges(session.rows())
        known = seen[0][2]
        for _ in range(6):
            taps(session, 1)
        more, _ = edges(session.rows())
        self.assertGreater(len(more), 3)
        self.assertEqual(len(seen), 1)  # nobody called meanwhile
        go_on.set()
        session.close()
        self.assertEqual(len(seen), 2)
        self.assertEqual(seen[1][2], len(begins) + len(more) - known)

    def test_never_on_the_thread_of_the_ticks_and_at_most_60_a_second(self):
        threads, calls = set(), []

        def told(event):
            threads.add(threading.get_ident())
            calls.append(event)
        session = scene().session()
        session.on("touch", told)
        session.on("leave", told)
        begun = time.monotonic()
        taps(session, 30)
        session.close()
        took = time.monotonic() - begun
        self.assertEqual(len(threads), 1)
        self.assertNotIn(threading.get_ident(), threads)
        # true on any machine: a slow one only makes `took` longer. The round of close() comes in addition.
        self.assertLessEqual(len(calls), 2 * (60 * took + 2))

    def test_removed_by_label(self):
        of_all, of_far, of_nerve = [], [], []
        with scene().session() as session:
            session.on("removed", of_all.append)
            session.on("removed", of_far.append, label="far bone")
            session.on("removed", of_nerve.append, label="nerve")
            session.hand((0, -4e-3, 4e-3), lean(), 1, ticks=0)
            session.step(600)
            for n in range(8):
                session.hand((0, (-1) ** n * 3.5e-3, 1.1e-3 - 0.05e-3 * n), ticks=150)
                session.step(150)
            voxels = session.removed()
        labels = plate().labels()[voxels[:, 3], voxels[:, 2], voxels[:, 1]]
        total = {}
        for event in of_all:
            for name, count in event.voxels.items():
                total[name] = total.get(name, 0) + count
        self.assertEqual(total, {name: int((labels == n).sum()) for n, name in ((1, "bone"), (3, "far bone"))})
        self.assertEqual(sum(event.voxels["far bone"] for event in of_far), total["far bone"])
        self.assertEqual(sum(event.count for event in of_far), total["far bone"])
        self.assertEqual(of_nerve, [])
        self.assertGreater(total["far bone"], 0)

    def test_near_a_structure(self):
        seen = []
        with scene().session() as session:
            session.on("near", seen.append, structure="nerve", mm=1.5)
            session.hand((-4e-3, 0, 4e-3), lean(), 0, ticks=0)
            session.step(600)
            for x in (0, -4e-3, 0, -4e-3):  # over the nerve and away
                session.hand((x, 0, 1.4e-3), ticks=300)
                session.step(300)
            rows = session.rows()
        distance = plate().distance_to(["nerve"], reach_mm=10).at(rows["proxy_m"]) - 1.5e-3
        inside = np.concatenate(([False], distance < 1.5e-3))
        enters = np.flatnonzero(inside[1:] & ~inside[:-1])
        self.assertEqual(len(enters), 2)
        self.assertEqual(sum(event.count for event in seen), 2)
        self.assertEqual((seen[0].first_tick, seen[-1].tick), (enters[0], enters[-1]))
        self.assertEqual(seen[0].structure, "nerve")
        self.assertAlmostEqual(seen[0].distance_m, distance[enters].min() if len(seen) == 1 else distance[enters[0]], places=12)

    def test_a_step_of_the_case_is_reached(self):
        # the built-in case, done a little earlier
        text = burr.Scene("block", voxel_mm=0.5, burr_mm=4).to_toml()
        self.assertEqual(text.count("share = 0.8"), 2)
        work = burr.Scene.from_toml(text.replace("share = 0.8", "share = 0.05"))
        seen = []
        session = work.session(burr.Hand.motion("pocket", seconds=1))
        session.on("step_reached", seen.append, step="groove")
        session.step(100)
        session.close()
        self.assertEqual(seen, [])  # not yet
        with work.session() as session:
            session.on("step_reached", seen.append)
            session.hand((-8e-3, 0, 19e-3), lean(), 1, ticks=0)
            session.step(600)
            for n in range(20):
                session.hand(((-1) ** n * 8e-3, 0, 16.4e-3 - 0.1e-3 * n), ticks=300)
                session.step(300)
        self.assertEqual([(event.step, event.count) for event in seen], [("groove", 1)])  # once, and not the second groove

    def test_what_a_function_raises_is_told_at_the_next_step(self):
        told = threading.Event()

        def bad(event):
            told.set()
            raise ValueError("not today")
        session = scene().session()
        session.on("touch", bad)
        session.hand((0, 0, 4e-3), lean(), 0, ticks=0)
        session.step(600)
        session.hand((0, 0, 1.2e-3), ticks=100)
        session.step(100)
        told.wait()
        raised = None
        while raised is None:  # the helper thread notes it when the function has returned
            try:
                session.step(1)
            except burr.Error as error:
                raised = error
        self.assertEqual(str(raised), 'the function for the event "touch" raised ValueError: not today; it is not called again')
        self.assertIsInstance(raised.__cause__, ValueError)
        made = session.ticks
        taps(session, 1)  # the session goes on; nobody is told any more
        self.assertEqual(session.ticks, made + 800)
        session.close()

    def test_what_a_function_raises_is_told_at_close(self):
        session = scene().session()
        session.on("leave", lambda event: 1 // 0)
        taps(session, 1)
        with self.assertRaisesRegex(burr.Error, "ZeroDivisionError"):
            session.close()
        self.assertTrue(session.closed)
        session.close()

    def test_a_scene_tells_of_all_its_sessions(self):
        work, seen = scene(), []
        work.on("touch", seen.append)
        for _ in range(2):
            with work.session() as session:
                taps(session, 1)
        self.assertEqual({event.event for event in seen}, {"touch"})
        self.assertGreaterEqual(len(seen), 2)

    def test_the_ticks_are_the_same_with_events(self):
        def hashes(**events):
            with scene().session(burr.Hand.motion("pocket", seconds=1)) as session:
                for event in events:
                    session.on(event, lambda event: None, **events[event])
                session.step(1000)
                return session.rows()["hash"].tolist(), session.removed().tolist()
        self.assertEqual(hashes(touch={}, leave={}, removed={}, near={"structure": "nerve", "mm": 2}), hashes())

    def test_back_to_the_beginning(self):
        seen = []
        session = scene().session()
        session.on("touch", seen.append)
        taps(session, 1)
        session.reset_to()
        taps(session, 1)
        begins, _ = edges(session.rows())
        session.close()
        self.assertEqual(sum(event.count for event in seen), 2 * len(begins))

    def test_wrong_wishes_are_refused_with_a_sentence(self):
        session = scene().session()
        quiet = scene().session(voxels=False)
        for call, words in [(lambda: session.on("jump", print), "touch, leave, removed, near or step_reached"),
                            (lambda: session.on("touch", 7), "give a function"),
                            (lambda: session.on("touch", print, label="bone"), 'label belongs to the event "removed"'),
                            (lambda: session.on("removed", print, label="liver"), 'no tissue "liver"; it has bone, nerve, far bone'),
                            (lambda: session.on("near", print, structure="nerve"), "a structure and a distance"),
                            (lambda: session.on("near", print, structure="nerve", mm=50), "above 0 to 20"),
                            (lambda: session.on("step_reached", print), "only a case has steps"),
                            (lambda: burr.Scene("block", voxel_mm=1).session().on("step_reached", print, step="dance"),
                             'no step "dance" that says when it is done; it has groove, second-groove'),
                            (lambda: burr.Scene("tooth", voxel_mm=0.4).session().on("step_reached", print), "no step of this case"),
                            (lambda: quiet.on("removed", print), "voxels=True")]:
            with self.assertRaises(burr.Error) as raised:
                call()
            self.assertIn(words, str(raised.exception))
        refused = []

        def close(event):
            try:
                session.close()
            except burr.Error as error:
                refused.append(str(error))
        session.on("touch", close)
        taps(session, 1)
        session.close()
        self.assertIn("cannot close its session", refused[0])

    def test_sessions_that_nobody_closes(self):
        class Holder:
            pass
        holder = Holder()
        session = scene().session()
        holder.session = session
        session.on("touch", lambda event, holder=holder: holder)  # a circle: session, function, session
        taps(session, 1)
        gone = weakref.ref(holder)
        del holder, session
        gc.collect()
        self.assertIsNone(gone())
        # and one that still waits for the GIL when Python ends
        done = subprocess.run([sys.executable, "-c", "import sys, time; sys.path.insert(0, %r); import events_test as t\n"
                               "session = t.scene().session()\n"
                               "session.on('touch', lambda event: time.sleep(0.2))\n"
                               "t.taps(session, 3)\n" % os.path.dirname(os.path.abspath(__file__))],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
