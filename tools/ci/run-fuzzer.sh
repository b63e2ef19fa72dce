#!/bin/sh
# Runs one fuzzer for FUZZ_TIME seconds from the inputs that it found before and FUZZ_SEED, 0 for one of the clock's.
# run-fuzzer.sh PROGRAM
set -u
name=$(basename "$1")
corpus=$(dirname "$1")/corpus-$name
found=$(dirname "$1")/found-$name-
mkdir -p "$corpus"
if "$1" -max_total_time="${FUZZ_TIME:-60}" -seed="${FUZZ_SEED:-0}" -timeout=10 -len_control=0 -rss_limit_mb=4096 \
    -max_len=4096 -print_final_stats=1 -artifact_prefix="$found" "$corpus" >"$1.log" 2>&1; then
    seed=$(sed -n 's/^INFO: Seed: //p' "$1.log")
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$1.log")
    echo "  pass $name in ${FUZZ_TIME:-60} s: $runs runs from seed $seed"
else
    tail -40 "$1.log"
    echo "  FAIL $name: the input is at $found*"
    exit 1
fi
