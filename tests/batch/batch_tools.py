"""What the tests of `burr batch` have in common: manifests, shards, merged tables."""
import os
import pathlib
import random
import signal
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEAD = "# burr-manifest 1\n"


class Batch:
    """A folder with a manifest, and the program."""

    def __init__(self, burr, folder, text):
        self.burr, self.folder = str(burr), pathlib.Path(folder)
        self.manifest = self.folder / "m.csv"
        self.manifest.write_text(text)

    def words(self, out, shard="0/1", *more):
        return [self.burr, "--quiet", "batch", "--manifest", self.manifest, "--shard", shard, "--out", self.folder / out, *more]

    def do(self, out, shard="0/1", *more, code=0, env=None):
        done = subprocess.run([str(word) for word in self.words(out, shard, *more)], capture_output=True, text=True,
                              env=dict(os.environ) | (env or {}))
        assert done.returncode == code, f"shard {shard} of {out}: {done.returncode} in place of {code}: {done.stdout}{done.stderr}"
        return done.stderr + done.stdout

    def all(self, out, shards, **how):
        for shard in range(shards):
            self.do(out, f"{shard}/{shards}", **how)

    def merge(self, out, *more, code=0):
        """The merged table, as bytes; where it is refused, what is said."""
        table, base = self.folder / f"{out}.csv", self.folder / f"{out}.sqlite"
        done = subprocess.run([self.burr, "merge", str(self.folder / out), "--manifest", str(self.manifest), "--out", str(table), "--sqlite",
                               str(base), *more], capture_output=True, text=True)
        assert done.returncode == code, f"merge of {out}: {done.returncode} in place of {code}: {done.stdout}{done.stderr}"
        return table.read_bytes() + base.read_bytes() if code == 0 else done.stdout + done.stderr

    def results(self, out):
        """The bytes of each result; those of its times are left out."""
        folder = self.folder / out / "results"
        return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*.json") if not file.name.endswith(".time.json")}

    def remains(self, out):
        return [file for file in (self.folder / out).rglob("*") if ".part-" in file.name]


def killed_again_and_again(batch, out, shards, kills, seed, longest_s):
    """Does the shards in a random order and kills, then goes on. Every other kill comes at a random moment, by SIGKILL or SIGTERM; the others
    when the file of a result is just there, which then must be whole. Returns how many kills met a running program."""
    chance, met = random.Random(seed), 0
    while met < kills and done_rows(batch, out) < rows(batch):
        shard, before = chance.randrange(shards), done_rows(batch, out)
        program = subprocess.Popen([str(word) for word in batch.words(out, f"{shard}/{shards}")], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        number = chance.choice((signal.SIGKILL, signal.SIGTERM))
        if met % 2 == 0:
            time.sleep(chance.uniform(0, longest_s))
        else:
            number = signal.SIGKILL
            while program.poll() is None and done_rows(batch, out) == before:
                time.sleep(0.002)
        if program.poll() is None:
            program.send_signal(number)
            met += 1
        ended = program.wait()
        assert ended in (0, 143, -signal.SIGKILL, -signal.SIGTERM), f"shard {shard} of {out}: {ended}"  # -SIGTERM: before main
    for shard in range(shards):
        batch.do(out, f"{shard}/{shards}")
    return met


def rows(batch):
    return sum(1 for line in batch.manifest.read_text().splitlines() if line and not line.startswith("#")) - 1


def done_rows(batch, out):
    return sum(1 for file in (batch.folder / out / "results").rglob("*.json") if not file.name.endswith(".time.json"))
