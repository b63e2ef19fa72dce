#!/bin/sh
# What `talus profile` writes, read back: the page by a browser, its figures held against --json; the trace events by the
# format's rules; the rows of the CSV; the exit statuses. check-profile-page.sh TOOL
set -u
tool=$1
subcommand=profile
dir=${BUILD:-build}/profile-page
browser=
for name in chromium chromium-browser google-chrome; do
    command -v $name >/dev/null 2>&1 && browser=$name && break
done
if [ -z "$browser" ]; then
    echo "  no chromium: sh tools/ci/install-deps.sh full installs it"
    exit 1
fi
rm -rf "$dir"
mkdir -p "$dir"
. tools/ci/count.sh

# dump PAGE OUT LOG SCHEME: the document as it stands once its scripts have run; SCHEME 0 is dark, 1 light
dump() {
    timeout 120 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$dir/browser" --virtual-time-budget=10000 \
        --enable-logging=stderr --blink-settings=preferredColorScheme="$4" --dump-dom "file://$(realpath "$1")" >"$2" 2>"$3"
}

# page SCENE OPTION...: a profile of a scene, by all ways of writing it at once
page() {
    scene=$1
    shift
    out=$dir/$scene
    "$tool" profile "@$scene" "$@" --runs 2 --json --html "$out.html" --trace "$out.trace" --csv "$out.csv" >"$out.json" 2>"$out.err"
    status=$?
    [ $status -eq 0 ] || [ $status -eq 7 ]
    count "$scene is profiled" $?
    for scheme in 0 1; do
        dump "$out.html" "$out.$scheme.dom" "$out.$scheme.log" $scheme && python3 tools/ci/check_profile.py page "$out.json" "$out.$scheme.dom" "$out.$scheme.log"
        count "$scene's page has the figures of its JSON ($([ $scheme = 0 ] && echo dark || echo light))" $?
    done
    python3 tools/ci/check_profile.py trace "$out.json" "$out.trace"
    count "$scene's trace events" $?
    python3 tools/ci/check_profile.py csv "$out.json" "$out.csv"
    count "$scene's rows" $?
}

# explained SCENE: another time if something else may have got into the worst step of all five runs
explained() {
    for try in 1 2 3; do
        "$tool" profile "@$1" --json >"$dir/why.json" && python3 tools/ci/check_profile.py why "$dir/why.json" && return
    done
    return 1
}

page pile --steps 300 --budget 1
page ragdolls --steps 120
for scene in $("$tool" scene --list | awk '{ print $1 }'); do
    explained "$scene"
    count "$scene's worst step is explained by what it held" $?
done
exits 0 "within the budget" @stack --steps 20 --budget 1000
exits 7 "over the budget" @stack --steps 20 --budget 0.000001
grep -q "go over the budget of 1e-06 ms" "$dir/err"
count "says which step is over" $?
exits 2 "no scene" --steps 20
exits 2 "no such scene" @nothing
exits 2 "a budget that is none" @stack --budget little
exits 1 "no such folder" @stack --steps 5 --csv "$dir/no/where.csv"
exits 1 "no such profile" --compare "$dir/none.json" "$dir/pile.json"
exits 4 "not a profile" --compare "$dir/pile.csv" "$dir/pile.json"
exits 2 "other scenes" --compare "$dir/pile.json" "$dir/ragdolls.json"
exits 2 "two files on one output" @stack --steps 2 --csv - --json
exits 2 "a comparison with options" --compare --json "$dir/pile.json" "$dir/pile.json"
"$tool" record @stack --steps 40 -o "$dir/stack.trec" >/dev/null
world_hash() { sed -n 's/.*"world_hash":"\([0-9a-f]*\)".*/\1/p'; }
a=$("$tool" profile "$dir/stack.trec" --json | world_hash)
b=$("$tool" profile @stack --steps 40 --json | world_hash)
[ -n "$a" ] && [ "$a" = "$b" ]
count "a recording is profiled, to the same state as its scene" $?
exits 2 "a recording has its own sub-steps" "$dir/stack.trec" --substeps 2
head -c 400 "$dir/stack.trec" >"$dir/cut.trec"
exits 4 "a recording cut off before its first state" "$dir/cut.trec"
exits 0 "the same profile" --compare "$dir/pile.json" "$dir/pile.json"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
