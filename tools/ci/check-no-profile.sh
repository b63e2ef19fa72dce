#!/bin/sh
# Whether TALUS_NO_PROFILE leaves nothing of the profiler: the files of the step that speak of it, compiled with it and
# compiled from a copy out of which every line and argument of the profiler was cut, must give the same machine code; and
# the library built with it must give the golden hashes. CC, BUILD
set -u
CC=${CC:-gcc}
BUILD=${BUILD:-build}
dir=$BUILD/no-profile
rm -rf "$dir/cut"
mkdir -p "$dir/cut"
bad=0
flags="-std=c99 -ffp-contract=off -fno-strict-aliasing -Iinclude -Isrc -Iplatform"

# A step that was handed a talus_profile answers with zeros: that much of tl_watch_stop stays.
cut() {
    sed -e 's/^ *tl_watch_stop(&w, world, \(.*\));/    if (\1) { static const talus_profile nothing; *\1 = nothing; }/' \
        -e '/^ *tl_watch_[a-z]*(/d' -e '/^ *tl_ties_changed(/d' -e '/^ *tl_watch w;$/d' -e '/watch\.h"$/d' \
        -e 's/, tl_watch \*w)/)/; s/, &w)/)/; s/, w)/)/' "$1"
}

for file in src/world/pipeline.c src/stage/store/lists.c src/world/reindex.c; do
    name=$(basename "$file" .c)
    cut "$file" >"$dir/cut/$name.c"
    if grep -n 'tl_watch\|tl_profile\|tl_ties' "$dir/cut/$name.c"; then
        echo "  $file: the profiler was not cut out whole"
        bad=1
    fi
    for level in -O2 -O3; do
        # shellcheck disable=SC2086
        $CC $flags $level -DTALUS_NO_PROFILE -c "$file" -o "$dir/with.o" &&
            $CC $flags $level -DTALUS_NO_PROFILE -c "$dir/cut/$name.c" -o "$dir/without.o" || bad=1
        for o in with without; do
            objdump -dr --no-show-raw-insn "$dir/$o.o" | sed '/file format/d' >"$dir/$o.txt"
        done
        if ! cmp -s "$dir/with.txt" "$dir/without.txt" || [ "$(wc -l <"$dir/with.txt")" -lt 100 ]; then
            echo "  $file at $level: the code differs from that without a profiler"
            bad=1
        fi
    done
done

make --no-print-directory -s -j"${JOBS:-2}" CC="$CC" BUILD="$dir" CFLAGS="-DTALUS_NO_PROFILE" "$dir/golden" >"$dir/log" 2>&1 || {
    tail -20 "$dir/log"
    bad=1
}
if nm "$dir/src/world/profile.o" | grep -E ' [tT] ' | grep -vE ' talus_world_(frame_count|get_frame)$'; then
    echo "  the profiler's own code is still there"
    bad=1
fi
"$dir/golden" 2>/dev/null | cmp -s - tests/golden/hashes.txt || {
    echo "  the golden hashes differ"
    bad=1
}
[ $bad -eq 0 ] && echo "  pass no profiler: the same code as if never written"
exit $bad
