#!/usr/bin/env bash
#SBATCH --job-name=burr --cpus-per-task=1 --mem=400M --time=00:30:00
#SBATCH --signal=B:TERM@60 --requeue --open-mode=append
# One shard of a manifest as one task of an array of Slurm.
#
#     sbatch --array=0-63%16 samples/clusters/slurm.sh M.csv OUT 64        64 shards, 16 at a time
#
# BURR: the program; default: burr. A minute before its time is over, Slurm sends SIGTERM: burr finishes the row if it can, and ends
# with 143. The same line goes on with what is left; a task whose computer fails is begun again by Slurm itself.
exec "${BURR:-burr}" --quiet batch --manifest "$1" --shard "$SLURM_ARRAY_TASK_ID/$3" --out "$2" --finish --seconds-left 45
