#!/usr/bin/env python3
"""Runs a study on a private Slurm: munged, slurmctld and two slurmd in a temporary folder.

  slurm_test.py PROGRAM

The test submits a study as an array of three tasks on two nodes, which are processes of this machine.
One task is killed and requeued while it runs, and then continues. The merged files must be equal, byte
for byte, to those of a study that ran in one process. Needs slurm-wlm and munge; ends with 77
(skipped) without them.
"""
import getpass
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SKIPPED = 77
ROWS = 900
NODES = ("node1", "node2")
# All characters and words that a shell or Slurm interprets. "packjob" would begin the options of
# another job.
OUT = "out of $(touch evil) `touch evil` 'a' \"b\" #1 \\ %j packjob; touch evil"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def wait_for(what, condition, seconds=120.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.1)
    raise TimeoutError(f"no {what} after {seconds} s")


class Cluster:
    """Two nodes with a processor each, on which everybody is the user of this test."""

    def __init__(self, folder):
        self.folder = folder
        self.processes = []
        host = socket.gethostname().split(".")[0]
        key = f"{folder}/munge.key"
        with open(key, "wb") as file:
            file.write(os.urandom(1024))
        os.chmod(key, 0o600)
        user = getpass.getuser()
        for name in ("state", *(f"spool_{node}" for node in NODES)):
            os.mkdir(f"{folder}/{name}")
        with open(f"{folder}/slurm.conf", "w") as file:
            file.write(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool_%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd_%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd_%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
KillWait=1
PartitionName=main Nodes={",".join(NODES)} Default=YES MaxTime=INFINITE State=UP
""")
            for node in NODES:
                file.write(f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 "
                           f"Port={free_port()} CPUs=1 RealMemory=500 State=UNKNOWN\n")
        self.environment = dict(os.environ, SLURM_CONF=f"{folder}/slurm.conf",
                                TRACKBED_DATA=SOURCE)
        for name in list(self.environment):
            if name.startswith("SLURM_") and name != "SLURM_CONF":
                del self.environment[name]
        self.start("munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={folder}/munge.sock", f"--pid-file={folder}/munge.pid",
                   f"--log-file={folder}/munge.log", f"--seed-file={folder}/munge.seed")
        wait_for("munge", lambda: os.path.exists(f"{folder}/munge.sock"))
        self.start("slurmctld", "-D", "-i")
        for node in NODES:
            self.start("slurmd", "-D", "-N", node)
        wait_for("idle nodes", lambda: self.tell("sinfo", "--noheader", "--Node",
                                                 "--format=%t").split() == ["idle"] * len(NODES))

    def start(self, name, *args):
        path = shutil.which(name) or f"/usr/sbin/{name}"
        log = open(f"{self.folder}/{name}_{len(self.processes)}.out", "w")
        self.processes.append(subprocess.Popen([path, *args], env=self.environment, stdout=log,
                                               stderr=subprocess.STDOUT))

    def tell(self, *command, cwd=None):
        return subprocess.run(command, env=self.environment, cwd=cwd, capture_output=True, text=True,
                              check=False).stdout

    def stop(self):
        for process in reversed(self.processes):
            process.send_signal(signal.SIGTERM)
        for process in self.processes:
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()

    def state(self, job):
        """Returns the states of all tasks of a job, such as {'COMPLETED'}."""
        text = self.tell("scontrol", "show", "job", str(job), "--oneliner")
        return {word.split("=")[1] for word in text.split() if word.startswith("JobState=")}


def rows_of(folder):
    """Returns the number of rows that a shard has finished."""
    try:
        with open(f"{folder}/sweep.records", "rb") as file:
            return file.read().count(b"\n") - 1
    except FileNotFoundError:
        return 0


def check(program, work, cluster):
    shutil.copy(f"{SOURCE}/scenarios/winding.yaml", f"{work}/winding.yaml")
    with open(f"{work}/study.yaml", "w") as file:
        file.write("schema: 1\nname: study\nscenario: winding.yaml\n"
                   "set: {drive.plants: [mujoco], drive.time_limit: 0.5, expect: {}}\n"
                   f"sample: {{count: {ROWS}, method: sobol}}\n"
                   "vary: {mission.speed: {distribution: uniform, from: 1, to: 5}}\n"
                   "outputs: [metrics.mujoco.distance]\n")
    subprocess.run([program, "sweep", "-q", "-o", "whole", "study.yaml"], cwd=work,
                   env=cluster.environment, check=True)
    submitted = subprocess.run([program, "sweep", "submit", "study.yaml", "--tasks", "3", "-o", OUT],
                               cwd=work, env=cluster.environment, capture_output=True, text=True,
                               check=False)
    assert submitted.returncode == 0, submitted.stderr
    words = submitted.stdout.split()
    array, merge = (int(words[i + 1].strip(",")) for i, word in enumerate(words) if word == "job")
    shard = f"{work}/{OUT}/shard_1_of_3"
    wait_for("row of the first task", lambda: rows_of(shard) > 0)
    cluster.tell("scontrol", "requeue", f"{array}_1")
    wait_for("requeued task", lambda: "PENDING" in cluster.state(f"{array}_1"))
    before = rows_of(shard)
    assert 0 < before < ROWS // 3, f"the task was killed after {before} rows"
    # Without this option, the command would wait for two minutes.
    cluster.tell("scontrol", "update", f"JobId={array}_1", "StartTime=now")
    wait_for("merged study", lambda: cluster.state(merge) & {"COMPLETED", "FAILED", "CANCELLED"},
             seconds=300.0)
    for name in ("sweep.csv", "sweep.json"):
        with open(f"{work}/whole/{name}", "rb") as one, open(f"{work}/{OUT}/{name}", "rb") as other:
            assert one.read() == other.read(), f"{name} differs"
    # The manifest of the array's folder lists the submitted scripts, too.
    with open(f"{work}/whole/manifest.json") as one, open(f"{work}/{OUT}/manifest.json") as other:
        results = json.load(other)["results"]
        assert sorted(results) == ["study", "submission"], results
        assert json.load(one)["results"]["study"] == results["study"], "manifest.json differs"
    evil = [name for _, _, names in os.walk(work) for name in names if name == "evil"]
    assert not evil, "the name of the folder was run as a command"
    restarts = [word for word in cluster.tell("scontrol", "show", "job", f"{array}_1",
                                              "--oneliner").split() if word.startswith("Restarts=")]
    assert restarts == ["Restarts=1"], restarts
    print(f"{ROWS} rows in three tasks, one killed after {before} rows and requeued: the same bytes")


def main():
    program = os.path.abspath(sys.argv[1])
    if not all(shutil.which(name) or os.path.exists(f"/usr/sbin/{name}")
               for name in ("sbatch", "slurmctld", "slurmd", "munged")):
        print("skipped: needs slurm-wlm and munge")
        return SKIPPED
    work = tempfile.mkdtemp(prefix="trackbed_slurm_")
    os.chmod(work, 0o755)
    cluster = None
    try:
        cluster = Cluster(work)
        check(program, work, cluster)
    except (AssertionError, TimeoutError) as error:
        print(error)
        for name in sorted(os.listdir(work)):
            if name.endswith((".log", ".out")):
                with open(f"{work}/{name}", errors="replace") as file:
                    print(f"== {name}\n" + file.read()[-2000:])
        return 1
    finally:
        if cluster:
            cluster.stop()
        shutil.rmtree(work, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
