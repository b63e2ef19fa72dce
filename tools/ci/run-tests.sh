#!/bin/sh
# Runs the golden program and the test programs, some at once, and adds up what they tell.
# RUN=emulator BUILD=dir JOBS=n run-tests.sh GOLDEN TEST...
set -u
golden=$1
shift
JOBS=${JOBS:-$(nproc 2>/dev/null || echo 2)}
logs=$BUILD/logs
rm -rf "$logs"
mkdir -p "$logs"

# One program: its output to a log, its counts to a file beside it.
one='
name=$(basename "$1")
log=$2/$name.log
start=$(date +%s)
${RUN:-} "$1" >"$log" 2>&1
code=$?
took=$(($(date +%s) - start))
total=$(sed -n "s/^\[==========\] .*: \([0-9]*\) test(s) run.*/\1/p;s/^\[==========\] \([0-9]*\) test(s) run.*/\1/p" "$log" | tail -1)
good=$(sed -n "s/^\[  PASSED  \] \([0-9]*\) test(s).*/\1/p" "$log" | tail -1)
total=${total:-0}; good=${good:-0}; bad=$((total - good))
if [ $code -ne 0 ] && [ $bad -eq 0 ]; then bad=1; fi
if [ $code -eq 0 ] && [ $total -eq 0 ]; then bad=1; echo "ran no test" >>"$log"; fi
echo "$good $bad" >"$2/$name.count"
if [ $bad -eq 0 ]; then
    echo "  pass $name ($good, $took s)"
else
    echo "  FAIL $name ($bad of $((good + bad)), exit code $code)"
    grep -v "^\[ RUN      \]\|^\[       OK \]" "$log" | tail -40
fi
'
printf '%s\n' "$@" | xargs -P "$JOBS" -I{} sh -c "$one" sh {} "$logs"

# The hashes by every instruction set that is here.
by='
log=$3/golden-$2
if ${RUN:-} "$1" "$2" >"$log.log" 2>&1 && cmp -s "$log.log" tests/golden/hashes.txt; then
    echo "1 0" >"$log.count"
    echo "  pass golden hashes by $2"
else
    echo "0 1" >"$log.count"
    echo "  FAIL golden hashes by $2"
    diff tests/golden/hashes.txt "$log.log"
fi
'
${RUN:-} "$golden" --isas | tr ' ' '\n' | xargs -P "$JOBS" -I{} sh -c "$by" sh "$golden" {} "$logs"

passed=0
failed=0
for count in "$logs"/*.count; do
    read -r good bad <"$count"
    passed=$((passed + good))
    failed=$((failed + bad))
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
