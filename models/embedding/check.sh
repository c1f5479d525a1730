#!/bin/sh
# Runs a host and compares the line of three numbers that it prints with the answer.
# usage: check.sh ERROR "X;Y;Z" PROGRAM [ARGUMENT]...
# ERROR: how far off it may be, as a fraction of the answer's length.
error=$1 answer=$2
shift 2
printed=$("$@") || { echo "FAILED: $1: exit code $?"; exit 1; }
echo "$printed $(echo "$answer" | tr ';' ' ') $error" | awk '
  { for (i = 1; i <= 3; i++) { off += ($i - $(i+3))^2; size += $(i+3)^2 }
    printf "%s %s %s, off by %.1e of it, %s allowed\n", $1, $2, $3, sqrt(off / size), $7
    good = NF == 7 && off <= $7^2 * size }
  END { exit !(NR == 1 && good) }'
