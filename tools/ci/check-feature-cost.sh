#!/bin/sh
# What the features that a scene has not cost its step, in instructions: callgrind counts those of talus_world_step by
# line of the source, and feature_cost.py adds up the lines that speak of a feature, with all that they call.
#
# Why so: a time is right to a percent at best, and a library without the feature, to compare with, is not at hand. The
# counts are the same in every run, take in every test of a flag and every call with nothing to do, and miss only what a
# feature costs lines that do not name it: registers, bytes of a record. `talus bench features` times what these, and
# what of a feature is there without work, come to. CC, BUILD
set -eu
CC=${CC:-gcc}
dir=${BUILD:-build}/feature-cost
mkdir -p "$dir"
make --no-print-directory -s -j"${JOBS:-2}" CC="$CC" BUILD="$dir" OPT="-O3 -g" tool >"$dir/log" 2>&1 || {
    tail -20 "$dir/log"
    exit 1
}

# counts SCENE STEPS: without sleep, for a sleeping body costs nothing anyway
counts() {
    valgrind --tool=callgrind --callgrind-out-file="$dir/$1.out" --toggle-collect=talus_world_step --dump-line=yes \
        --compress-strings=no --compress-pos=no "$dir/talus" run "@$1" --steps "$2" --no-sleep --quiet >"$dir/$1.log" 2>&1 || {
        tail -20 "$dir/$1.log"
        exit 1
    }
}

counts pyramid 60 &
counts pile 120
wait $!
python3 tools/ci/feature_cost.py "$dir/pyramid.out" "$dir/pile.out"
