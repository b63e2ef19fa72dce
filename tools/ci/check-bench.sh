#!/bin/sh
# What `talus bench` writes by its quick forms, read back: the JSON's figures, the plots, the exit statuses.
# check-bench.sh TOOL
set -u
tool=$1
subcommand=bench
dir=${BUILD:-build}/bench
rm -rf "$dir"
mkdir -p "$dir"
. tools/ci/count.sh

# measures WHAT OPTION...
measures() {
    timeout 300 "$tool" bench "$@" --quick --json >"$dir/$1.json" && python3 tools/ci/check_bench.py "$1" "$dir/$1.json"
    count "$1 measured" $?
}

# draws WHAT: beside measuring it
draws() {
    measures "$1" --plot "$dir/$1.svg"
    python3 -c 'import sys, xml.etree.ElementTree as e; e.parse(sys.argv[1])' "$dir/$1.svg"
    count "$1 drawn" $?
}

draws queries
draws solver
measures features
exits 0 "one scene, in words" solver --quick --scene arch
grep -q '^arch: 15 bodies' "$dir/out" && ! grep -q '^stack:' "$dir/out"
count "only the scene that was asked for" $?
exits 0 "a plot alone" solver --quick --scene arch --plot -
grep -q '^<svg ' "$dir/out" && [ "$(tail -c 7 "$dir/out")" = "</svg>" ]
count "the plot and nothing else" $?
exits 2 "nothing to measure"
exits 2 "no such thing to measure" everything
exits 2 "no such scene" solver --scene heap
grep -q '"heap" is none of stack, pyramid' "$dir/err"
count "says which scenes there are" $?
exits 2 "scenes of what has none" queries --scene arch
exits 0 "one feature, in words" features --quick --feature joints
grep -q '^joints  *pyramid ' "$dir/out" && ! grep -q '^rolling  *pyramid ' "$dir/out"
count "only the feature that was asked for" $?
exits 2 "no such feature" features --feature everything
exits 2 "features of what has none" solver --feature joints
exits 2 "a plot of what has none" features --plot "$dir/features.svg"
exits 2 "two texts on one output" solver --json --plot -
exits 1 "no such folder" solver --quick --scene arch --plot "$dir/no/where.svg"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
