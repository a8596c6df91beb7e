#!/usr/bin/env python3
"""`burr batch` as an array of a real Slurm on this computer: the same bytes as without, after a time limit and after a task was requeued.

    tests/batch/slurm_test.py BURR

Needs root, munge, slurmctld and slurmd: where they are missing, the test is left out (exit 77), unless BURR_REQUIRE_TOOLS=1.
"""
import os
import pathlib
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from batch_tools import HEAD, ROOT, Batch  # noqa: E402
from slurm import Slurm, missing  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
SCRIPT = ROOT / "samples/clusters/slurm.sh"


def jobs_end(slurm):
    end = time.monotonic() + 120
    while slurm.run("squeue", "-h"):
        assert time.monotonic() < end, slurm.run("squeue") + slurm.logs()
        time.sleep(0.2)


def main():
    why = missing()
    if why:
        print(f"Slurm: {why}")
        return 1 if os.environ.get("BURR_REQUIRE_TOOLS") == "1" else 77
    with tempfile.TemporaryDirectory(prefix="burr_slurm_") as name:
        folder = pathlib.Path(name)
        batch = Batch(BURR, folder, HEAD + "id,command,case,seed,seconds\n" + "".join(f"s{n},surgeon,tooth,{n},4\n" for n in range(15)))
        batch.do("alone")
        began = time.monotonic()
        with Slurm(folder / "cluster") as slurm:
            slurm.env["BURR"] = str(BURR)
            submit = ["sbatch", "--parsable", "--array=0-2", f"--output={folder}/%a.log", SCRIPT, batch.manifest, folder / "slurm", "3"]
            first = slurm.run(*submit)
            # a computer of the cluster fails: Slurm begins its tasks again; and somebody ends one by SIGTERM
            end = time.monotonic() + 60
            while len(batch.results("slurm") if (folder / "slurm" / "results").exists() else ()) < 2:
                assert time.monotonic() < end, slurm.logs()
                time.sleep(0.05)
            slurm.run("scontrol", "requeue", f"{first}_0", code=None)
            slurm.run("scancel", "--signal=TERM", "--batch", f"{first}_1", code=None)
            slurm.run("scontrol", "release", f"{first}_0", code=None)
            time.sleep(1)
            slurm.run("scancel", first, code=None)
            jobs_end(slurm)
            left = 15 - len(batch.results("slurm"))
            slurm.run(*submit)
            jobs_end(slurm)
        said = "".join(log.read_text() for log in sorted(folder.glob("*.log")))
        assert batch.results("slurm") == batch.results("alone"), said
        assert batch.merge("slurm") == batch.merge("alone")
        print(f"15 rows on Slurm, {left} of them after its tasks were ended: equal bytes; {time.monotonic() - began:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
