"""A job array for Slurm: a row a job, for clusters that have no dask scheduler."""
import os
import shlex
import sys
from pathlib import Path

from calibration.generated import ROOT

ARRAY = """\
#!/bin/bash
# sbatch {file}
# A row a job. Two to three minutes before its time limit it gets SIGUSR1, writes a checkpoint and is queued again; a
# limit below five minutes leaves it no time to run. At SIGTERM it writes one, too: after preemption Slurm queues it
# again, after scancel `sbatch` of this file once more runs the rows that are missing. The page: the command that wrote
# this file, with --read in place of --slurm.
#SBATCH --job-name=rockwear
#SBATCH --array=1-{count}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={threads}
#SBATCH --requeue
#SBATCH --signal=B:USR1@120
#SBATCH --output="{folder}/slurm-%a.log"
#SBATCH --open-mode=append
cd {directory} || exit 2
export PYTHONPATH={root}
{command} --row "$SLURM_ARRAY_TASK_ID" &
row=$!
limit=
trap 'limit=yes; kill -TERM $row' USR1
trap 'kill -TERM $row' TERM
# A signal ends `wait`, while the row is still writing its checkpoint.
while wait $row; code=$?; kill -0 $row 2>/dev/null; do :; done
[ -z "$limit" ] || scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
exit $code
"""


def _quoted(path):
    """A path as sbatch reads it between double quotes: % begins a pattern there."""
    return str(path).replace("\\", "\\\\").replace('"', '\\"').replace("%", "%%")


def write(file, rows, table, script, folder):
    """Write the job array of these rows to `file`. -> exit code."""
    paths = [str(Path(path).resolve()) for path in (table, script)]
    command = shlex.join([sys.executable, "-m", "calibration.sweep", *paths, "--out", str(folder.resolve())])
    threads = max(row.threads for row in rows)
    file.write_text(ARRAY.format(
        file=shlex.quote(str(file)), count=len(rows), threads=threads, root=shlex.quote(str(ROOT)),
        directory=shlex.quote(os.getcwd()), folder=_quoted(folder.resolve()), command=command), encoding="utf-8")
    print(f"{file}: {len(rows)} rows")
    return 0
