#!/usr/bin/env bash
# All shards of a manifest on this computer by GNU parallel, as many at a time as there are processors.
#
#     samples/clusters/parallel.sh M.csv OUT SHARDS
#
# BURR: the program; default: burr. OUT/joblog says which shards are done. The same line goes on with the others, and tries those
# again that left rows. On several computers with a common OUT: add --sshlogin to parallel.
set -euo pipefail
manifest=$1 out=$2 shards=$3
mkdir -p "$out"
seq 0 $((shards - 1)) |
  parallel --jobs "${JOBS:-$(nproc)}" --joblog "$out/joblog" --resume-failed --termseq TERM,10000,KILL,1000 \
    "${BURR:-burr}" --quiet batch --manifest "$manifest" --shard "{}/$shards" --out "$out"
