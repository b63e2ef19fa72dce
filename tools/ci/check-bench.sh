#!/bin/sh
# What `talus bench` writes by its quick forms, read back: the JSON's figures, the plots, the exit statuses.
# check-bench.sh TOOL
set -u
tool=$1
dir=${BUILD:-build}/bench
rm -rf "$dir"
mkdir -p "$dir"
passed=0
failed=0
count() {
    if [ "$2" -eq 0 ]; then
        passed=$((passed + 1))
        echo "  pass $1"
    else
        failed=$((failed + 1))
        echo "  FAIL $1"
    fi
}

# measures WHAT: by JSON, in words, and as a plot
measures() {
    timeout 300 "$tool" bench "$1" --quick --json --plot "$dir/$1.svg" >"$dir/$1.json" && python3 tools/ci/check_bench.py "$1" "$dir/$1.json"
    count "$1 measured" $?
    python3 -c 'import sys, xml.etree.ElementTree as e; e.parse(sys.argv[1])' "$dir/$1.svg"
    count "$1 drawn" $?
}

# exits WITH NAME OPTION...: an exit status
exits() {
    want=$1
    name=$2
    shift 2
    "$tool" bench "$@" >"$dir/out" 2>"$dir/err"
    got=$?
    [ $got -eq "$want" ] || cat "$dir/err"
    [ $got -eq "$want" ]
    count "$name: exit status $want" $?
}

measures queries
measures solver
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
exits 2 "two texts on one output" solver --json --plot -
exits 1 "no such folder" solver --quick --scene arch --plot "$dir/no/where.svg"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
