#!/bin/sh
# Runs one fuzzer for FUZZ_TIME seconds from the inputs that it found before. run-fuzzer.sh PROGRAM
set -u
name=$(basename "$1")
corpus=$(dirname "$1")/corpus-$name
found=$(dirname "$1")/found-$name-
mkdir -p "$corpus"
if "$1" -max_total_time="${FUZZ_TIME:-60}" -timeout=10 -len_control=0 -rss_limit_mb=4096 -max_len=4096 -print_final_stats=1 \
    -artifact_prefix="$found" "$corpus" >"$1.log" 2>&1; then
    sed -n "s/^stat::number_of_executed_units: *\(.*\)/  pass $name in ${FUZZ_TIME:-60} s: \1 runs/p" "$1.log"
else
    tail -40 "$1.log"
    echo "  FAIL $name: the input is at $found*"
    exit 1
fi
