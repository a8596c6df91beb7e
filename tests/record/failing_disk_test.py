#!/usr/bin/env python3
"""failing_disk_test.py BURR COMPILER - each call of a recording fails in turn, with each errno: the exit code,
the sentence and the file that is kept are right. And a recording is closed by the signals that ask to end.

failing_disk.c makes the calls fail. What was kept is read by `burr replay --check`, without it.
"""
import errno
import json
import os
import pathlib
import pty
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BURR = pathlib.Path(sys.argv[1]).resolve()
COMPILER = sys.argv[2] if len(sys.argv) > 2 else "cc"
HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 3
SESSION = [BURR, "--quiet", "mill", "phantom:block", "--voxel-mm", "0.5", "--burr-mm", "4", "--motion", "pocket"]
MILL = [*SESSION, "--seconds", str(SECONDS), "--json", "--force"]
GOES_ON = "the session continues without recording"
NO_LOCKS = "has no locks"

# errno -> the remedy that the sentence gives
REMEDIES = {
    errno.ENOSPC: "free some space", errno.EDQUOT: "free some space", errno.EACCES: "choose a folder that you may write to",
    errno.EPERM: "choose a folder that you may write to", errno.EROFS: "choose a folder that you may write to",
    errno.EFBIG: "raise the limit on file size", errno.EIO: "choose another disk", errno.EMFILE: "ulimit -n",
    errno.ESTALE: "connect it again", errno.ETIMEDOUT: "connect it again", errno.ENODEV: "connect it again",
    errno.ENOMEM: "end other programs", errno.EBUSY: "another program uses it",
}


class FailingDisk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = pathlib.Path(tempfile.mkdtemp())
        cls.shim = cls.place / "failing_disk.so"
        subprocess.run([COMPILER, "-shared", "-fPIC", "-O1", "-o", cls.shim, HERE / "failing_disk.c", "-ldl"], check=True)
        cls.older = cls.place / "older.mcap"
        subprocess.run([*SESSION, "--seconds", "1", "--record", cls.older], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.place)

    def mill(self, call, number, after=0, times=None, old=False, beside=False, paced=False, short=False):
        """One session whose disk fails; an object with the exit code, what was said, and the figures."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.place))
        file = folder / "s.mcap"
        if old:
            shutil.copy(self.older, file)
        if beside:
            (folder / "s.mcap.part").write_bytes(b"left by a burr that was killed")
        about = {"LD_PRELOAD": str(self.shim), "FAIL_CALL": call, "FAIL_ERRNO": str(number), "FAIL_PATH": "s.mcap",
                 "FAIL_AFTER": str(after)}
        if call == "fsync":
            about["FAIL_PATH"] = str(folder)
        if times is not None:
            about["FAIL_TIMES"] = str(times)
        if short:
            about["FAIL_SHORT"] = "1"
        done = subprocess.run([*MILL, *(["--realtime"] if paced else []), "--record", file], env={**os.environ, **about},
                              capture_output=True, text=True, timeout=120)
        done.file, done.said = file, json.loads(done.stdout.splitlines()[-1]) if done.stdout else None
        done.names = sorted(one.name for one in folder.iterdir())
        return done

    def replays(self, file, ticks):
        """Opens, has so many ticks, and each is the same when it is simulated again."""
        done = subprocess.run([BURR, "replay", file, "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout + done.stderr, rf"\b{ticks} ticks")

    def whole(self, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.said["recording"]["whole"])
        self.assertEqual(done.names, ["s.mcap"])
        self.replays(done.file, 1000 * SECONDS)

    def fails(self, done, sentence, number, kept):
        """74, one sentence with the system's words and a remedy; kept: nothing, older, some, all."""
        self.assertEqual(done.returncode, 74, done.stderr)
        self.assertRegex(done.stderr, sentence)
        self.assertIn(os.strerror(number), done.stderr)
        self.assertIn(REMEDIES[number], done.stderr)
        self.assertAlmostEqual(done.said["seconds"], SECONDS, delta=0.01, msg="it mills to the end")
        self.assertFalse(done.said["recording"]["whole"])
        ticks = done.said["recording"]["ticks"]
        self.assertEqual(GOES_ON in done.stderr, kept != "all", done.stderr)
        self.assertEqual("is incomplete" in done.stderr, kept != "all", done.stderr)
        if kept == "nothing":
            self.assertEqual(done.names, [])
            self.assertIn("nothing was kept", done.stderr)
        elif kept == "older":
            self.assertEqual(done.names, ["s.mcap"])
            self.assertEqual(done.file.read_bytes(), self.older.read_bytes(), "an older recording stays")
            self.assertIn("nothing was kept", done.stderr)
        elif kept == "some":
            self.assertGreater(ticks, 0)
            self.assertLess(ticks, 1000 * SECONDS)
            self.assertIn(f"it holds the first {ticks / 1000:.3f} s", done.stderr)
            self.replays(done.file, ticks)
        else:
            self.assertEqual(ticks, 1000 * SECONDS)
            self.assertIn("can be read in the recording", done.stderr)
            self.replays(done.file, ticks)

    # ---- what a disk need not offer

    def test_locks_are_not_needed(self):
        for number in (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL, errno.EIO):
            with self.subTest(errno=errno.errorcode[number]):
                done = self.mill("flock", number)
                self.whole(done)
                self.assertEqual(done.stderr.count(NO_LOCKS), 1, done.stderr)
        self.assertNotIn(NO_LOCKS, self.mill("none", 0).stderr)

    def test_a_lock_of_another_is_respected(self):
        done = self.mill("flock", errno.EWOULDBLOCK, old=True)
        self.assertEqual(done.returncode, 74)
        self.assertIn("another burr", done.stderr)
        self.assertEqual(done.file.read_bytes(), self.older.read_bytes())

    def test_to_bring_data_to_the_disk_at_once_is_not_needed(self):
        for number in (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP):
            self.whole(self.mill("fdatasync", number))
        for number in REMEDIES:
            self.whole(self.mill("fsync", number))

    def test_to_read_back_is_not_needed(self):
        for number in (errno.EIO, errno.ESTALE, errno.EBADF):
            self.whole(self.mill("pread", number))

    def test_to_look_at_a_file_is_not_needed(self):
        for number in (errno.EIO, errno.ESTALE):
            self.whole(self.mill("fstat", number))

    def test_to_shorten_a_file_is_not_needed(self):
        for number in (errno.EINVAL, errno.EPERM, errno.EIO):
            self.whole(self.mill("ftruncate", number, beside=True))

    def test_an_interrupted_call_is_made_again(self):
        for call in ("write", "fdatasync", "flock"):
            for after in (0, 5):
                self.whole(self.mill(call, errno.EINTR, after=after, times=3))

    # ---- what it must offer

    def test_no_file_can_be_opened(self):
        for number in (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOSPC, errno.EIO, errno.EMFILE, errno.ESTALE):
            with self.subTest(errno=errno.errorcode[number]):
                self.fails(self.mill("open", number), r"s\.mcap: cannot be written: ", number, "nothing")
                self.fails(self.mill("open", number, old=True), r"s\.mcap: cannot be written: ", number, "older")

    def test_nothing_can_be_written(self):
        for number in (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG, errno.ESTALE, errno.ETIMEDOUT):
            with self.subTest(errno=errno.errorcode[number]):
                for after in (0, 3):  # in its beginning, which is not under its name yet
                    self.fails(self.mill("write", number, after=after), r"s\.mcap: cannot be written", number, "nothing")
                self.fails(self.mill("write", number, old=True), r"s\.mcap: cannot be written", number, "older")

    def test_nothing_more_can_be_written(self):
        for number in (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG, errno.ESTALE, errno.ENODEV, errno.ENOMEM):
            with self.subTest(errno=errno.errorcode[number]):
                self.fails(self.mill("write", number, after=40, paced=True), r"s\.mcap: cannot be written further: ", number, "some")

    def test_it_cannot_be_flushed(self):
        for number in (errno.EIO, errno.ENOSPC, errno.EDQUOT, errno.ESTALE):
            with self.subTest(errno=errno.errorcode[number]):
                self.fails(self.mill("fdatasync", number), r"s\.mcap: cannot be flushed to the disk: ", number, "nothing")
                self.fails(self.mill("fdatasync", number, after=2), r"s\.mcap: cannot be flushed to the disk: ", number, "all")
                # the system says it once
                self.fails(self.mill("fdatasync", number, after=2, times=1), r"flushed to the disk: ", number, "all")

    def test_it_cannot_take_its_name(self):
        for number in (errno.EACCES, errno.EIO, errno.ENOSPC, errno.EBUSY):
            with self.subTest(errno=errno.errorcode[number]):
                self.fails(self.mill("rename", number), r"s\.mcap: cannot take this name: ", number, "nothing")
                self.fails(self.mill("rename", number, old=True), r"s\.mcap: cannot take this name: ", number, "older")

    def test_it_cannot_be_closed(self):
        for number in (errno.EIO, errno.ENOSPC, errno.EDQUOT):
            self.fails(self.mill("close", number), r"s\.mcap: cannot be closed: ", number, "all")

    def test_a_torn_end_is_read_as_far_as_it_goes(self):
        # half of a chunk is written, and it cannot be cut back
        done = self.mill("write,ftruncate", errno.EIO, after=40, paced=True, short=True)
        self.fails(done, r"s\.mcap: cannot be written further: ", errno.EIO, "some")

    # ---- a batch ends

    def test_a_batch_without_locks_ends(self):
        manifest = self.place / "m.csv"
        manifest.write_text("# burr-manifest 1\nid,command,volume,voxel-mm,burr-mm,motion,seconds\n" +
                            "".join(f"r{n},mill,phantom:block,0.5,4,pocket,1\n" for n in range(3)))
        for number in (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP):
            out = self.place / f"batch{number}"
            about = {"LD_PRELOAD": str(self.shim), "FAIL_CALL": "flock", "FAIL_ERRNO": str(number), "FAIL_PATH": "/"}
            done = subprocess.run([BURR, "batch", "--manifest", manifest, "--out", out, "--record"],
                                  env={**os.environ, **about}, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("0 left", done.stdout)
            recordings = sorted(out.rglob("*.mcap"))
            self.assertEqual(len(recordings), 3)
            for one in recordings:
                self.replays(one, 1000)

    # ---- signals

    def stopped_by(self, number, file, **more):
        session = subprocess.Popen([*SESSION, "--seconds", "60", "--realtime", "--record", file], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True, **more)
        self.wait_for(file)
        session.send_signal(number)
        said = session.communicate(timeout=60)[1]
        return session.returncode, said

    def wait_for(self, file):
        for _ in range(600):
            if file.exists() and file.stat().st_size > 200_000:
                return
            time.sleep(0.05)
        self.fail("nothing is recorded")

    def closed(self, file):
        done = subprocess.run([BURR, "repair", file], capture_output=True, text=True)
        self.assertIn("is complete, nothing to repair", done.stdout, done.stderr)
        done = subprocess.run([BURR, "replay", file, "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("stopped before its end", done.stdout + done.stderr)

    def test_signals_close_a_recording(self):
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
            with self.subTest(signal=number.name):
                file = self.place / f"{number.name}.mcap"
                code, said = self.stopped_by(number, file)
                self.assertEqual(code, 128 + number, said)
                self.closed(file)

    def test_nohup_is_obeyed(self):
        file = self.place / "nohup.mcap"
        session = subprocess.Popen(["nohup", *MILL, "--realtime", "--record", file], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self.wait_for(file)
        session.send_signal(signal.SIGHUP)
        self.assertEqual(session.wait(60), 0)
        self.replays(file, 1000 * SECONDS)

    def test_a_terminal_that_closes(self):
        file = self.place / "terminal.mcap"
        child, terminal = pty.fork()
        if child == 0:
            os.execv(BURR, [str(one) for one in [BURR, *SESSION[2:], "--seconds", "60", "--realtime", "--record", file]])
        os.set_blocking(terminal, False)
        for _ in range(600):
            try:
                os.read(terminal, 100_000)
            except BlockingIOError:
                pass
            if file.exists() and file.stat().st_size > 200_000:
                break
            time.sleep(0.05)
        os.close(terminal)
        status = os.waitpid(child, 0)[1]
        self.assertEqual(os.waitstatus_to_exitcode(status), 128 + signal.SIGHUP)
        self.closed(file)


if __name__ == "__main__":
    if sys.platform != "linux" or shutil.which(COMPILER) is None:
        print("needs Linux and a C compiler")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
