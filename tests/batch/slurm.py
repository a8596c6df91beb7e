"""A cluster of Slurm on this computer alone, for tests: munge, slurmctld and slurmd in a folder of their own, as root.

    with Slurm(folder) as slurm:
        slurm.run("sbatch", "--wait", "--array=0-2", script)

Nothing outside of the folder is touched; the daemons end with it.
"""
import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import sys
import time

# Where a daemon has its settings; proctrack/pgid and task/none need no control group of their own, which a container lacks.
CONF = """ClusterName=burr
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=10000
MaxArraySize=100001
MpiDefault=none
ReturnToService=2
KillWait=10
NodeName={host} NodeAddr=127.0.0.1 CPUs={processors} RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Why there can be no Slurm here; empty: there can."""
    if os.geteuid() != 0:
        return "only root can start slurmctld, slurmd and munged together"
    tools = [tool for tool in ("munged", "slurmctld", "slurmd", "sbatch") if not shutil.which(tool, path=os.environ["PATH"] + ":/usr/sbin")]
    return f"{', '.join(tools)}: missing (section [tools] of scripts/packages.txt)" if tools else ""


def free_ports(count):
    held = [socket.socket() for _ in range(count)]
    for one in held:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in held]
    for one in held:
        one.close()
    return ports


class Slurm:
    def __init__(self, folder, processors=None):
        self.folder = pathlib.Path(folder)
        self.processors = processors or os.cpu_count()
        self.daemons = []
        self.env = dict(os.environ) | {"PATH": os.environ["PATH"] + ":/usr/sbin", "SLURM_CONF": str(self.folder / "slurm.conf")}

    def begin(self, *command):
        name = pathlib.Path(command[0]).name
        log = open(self.folder / f"{name}.out", "wb")
        self.daemons.append(subprocess.Popen(command, env=self.env, stdout=log, stderr=log))

    def run(self, *command, code=0):
        done = subprocess.run([str(word) for word in command], env=self.env, capture_output=True, text=True, cwd=self.folder)
        if code is not None and done.returncode != code:
            raise AssertionError(f"{command}: {done.returncode}: {done.stdout}{done.stderr}\n{self.logs()}")
        return done.stdout.strip()

    def logs(self):
        return "\n".join(f"---- {log.name}\n" + "\n".join(log.read_text(errors="replace").splitlines()[-15:]) for log in self.folder.glob("*.out"))

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise
        return self

    def start(self):
        host = socket.gethostname().split(".")[0]
        munge = self.folder / "munge"
        self.folder.mkdir(exist_ok=True)
        self.folder.chmod(0o755)
        for name in ("munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        key = munge / "key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o600)
        (self.folder / "slurm.conf").write_text(
            CONF.format(host=host, folder=self.folder, ports=free_ports(2), processors=self.processors))
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        self.begin("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge / 'socket'}", f"--pid-file={munge / 'pid'}",
                   f"--seed-file={munge / 'seed'}", f"--log-file={munge / 'log'}", "--num-threads=2")
        self.until(lambda: (munge / "socket").exists(), "munged")
        self.begin("slurmctld", "-D", "-f", self.env["SLURM_CONF"])
        self.begin("slurmd", "-D", "-f", self.env["SLURM_CONF"], "-N", host)
        self.until(lambda: self.run("sinfo", "-h", "-o", "%t", code=None) == "idle", "slurmctld and slurmd")

    def until(self, ready, what, seconds=60):
        end = time.monotonic() + seconds
        while not ready():
            if time.monotonic() > end or any(daemon.poll() is not None for daemon in self.daemons):
                raise AssertionError(f"{what}: did not begin\n{self.logs()}")
            time.sleep(0.2)

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
