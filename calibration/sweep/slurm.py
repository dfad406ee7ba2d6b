"""A job array for Slurm: a row a job, for clusters that have no dask scheduler."""
import os
import shlex
import sys
from pathlib import Path

from calibration.generated import ROOT

ARRAY = """\
#!/bin/bash
# sbatch {file}
# A row a job. A job that is stopped at its time limit writes a checkpoint and is queued again; so does `sbatch` of this
# file once more with the rows that are missing. The page, when all have ended: the command below without --row.
#SBATCH --job-name=rockwear
#SBATCH --array=1-{count}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={threads}
#SBATCH --requeue
#SBATCH --signal=B:TERM@120
#SBATCH --output={folder}/slurm-%a.log
#SBATCH --open-mode=append
cd {directory} || exit 2
export PYTHONPATH={root}
{command} --row "$SLURM_ARRAY_TASK_ID" &
row=$!
trap 'kill -TERM $row' TERM
wait $row
code=$?
if [ $code -gt 128 ]; then
    wait $row
    [ -z "$SLURM_JOB_ID" ] || scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
fi
exit $code
"""


def write(file, rows, table, script, folder):
    """Write the job array of these rows to `file`. -> exit code."""
    paths = [str(Path(path).resolve()) for path in (table, script)]
    command = shlex.join([sys.executable, "-m", "calibration.sweep", *paths, "--out", str(folder.resolve())])
    threads = max(row.threads for row in rows)
    file.write_text(ARRAY.format(
        file=shlex.quote(str(file)), count=len(rows), threads=threads, root=shlex.quote(str(ROOT)),
        directory=shlex.quote(os.getcwd()), folder=folder.resolve(), command=command), encoding="utf-8")
    print(f"{file}: {len(rows)} rows")
    return 0
