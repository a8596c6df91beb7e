#!/usr/bin/env bash
# All shards of a manifest on this computer, one after the other: no cluster, no other program.
#
#     samples/clusters/loop.sh M.csv OUT SHARDS
#
# BURR: the program; default: burr. Ends with 75 if rows are left that may do at another time: the same line goes on.
set -uo pipefail
manifest=$1 out=$2 shards=$3 left=0
for ((shard = 0; shard < shards; ++shard)); do
  "${BURR:-burr}" --quiet batch --manifest "$manifest" --shard "$shard/$shards" --out "$out"
  code=$?
  case $code in
    0) ;;
    75) left=75 ;;
    *) exit $code ;; # stopped (130, 143), or a mistake that all shards would meet
  esac
done
exit $left
