#!/bin/sh
# Builds the golden program by every compiler and level at hand, runs it over every instruction set it has, and compares
# with tests/golden/hashes.txt. BUILD=dir FAST=1 golden.sh; FAST: only this machine's own kind of processor.
# MATRIX: lines of "name|compiler|flags|runner", in place of the built-in ones. JOBS of them are made at once, each by
# golden.sh LINE, which leaves in $BUILD/golden-NAME the hashes as ISA.txt, the names of the sets in `isas`, or in
# `trouble` why there are none.
set -u
BUILD=${BUILD:-build}
JOBS=${JOBS:-$(nproc 2>/dev/null || echo 2)}

# produce NAME COMPILER FLAGS RUNNER
produce() {
    dir=$BUILD/golden-$1
    mkdir -p "$dir"
    rm -f "$dir"/*.txt "$dir/isas" "$dir/trouble"
    if ! command -v "${2%% *}" >/dev/null 2>&1 || { [ -n "$4" ] && ! command -v "${4%% *}" >/dev/null 2>&1; }; then
        echo "skipped: no $2${4:+ or ${4%% *}}" >"$dir/trouble"
        return
    fi
    case $1 in wasm*) exe=.wasm ;; *) exe= ;; esac
    # unoptimised lanes need more than the 64 KiB of stack that wasm programs have
    case $4 in '') link= ;; node*) link=-Wl,-z,stack-size=1048576 ;; *) link=-static ;; esac
    if ! make --no-print-directory CC="$2" OPT="$3" CFLAGS= LDFLAGS="$link" EXE="$exe" BUILD="$dir" "$dir/golden$exe" \
        >"$dir/build.log" 2>&1; then
        echo "DOES NOT BUILD" | cat - "$dir/build.log" >"$dir/trouble"
        return
    fi
    $4 "$dir/golden$exe" --isas >"$dir/isas"
    [ -s "$dir/isas" ] || echo "DOES NOT RUN" >"$dir/trouble"
    for isa in $(cat "$dir/isas"); do
        $4 "$dir/golden$exe" "$isa" >"$dir/$isa.txt" 2>"$dir/$isa.err" || rm -f "$dir/$isa.txt"
    done
}
if [ $# -gt 0 ]; then
    IFS='|' read -r name compiler flags runner <<END
$1
END
    produce "$name" "$compiler" "$flags" "$runner" </dev/null
    exit
fi

want=tests/golden/hashes.txt
passed=0
failed=0
skipped=0
compared=0

# The scenes in which a list of hashes differs from what is wanted.
differing() { diff "$want" "$1" | sed -n 's/^> \([^ ]*\) .*/\1/p' | tr '\n' ' '; }
row() { printf '  %-18s %-8s %s\n' "$1" "$2" "$3"; }

# judge NAME
judge() {
    dir=$BUILD/golden-$1
    if [ -e "$dir/trouble" ]; then
        row "$1" - "$(head -1 "$dir/trouble")"
        tail -n +2 "$dir/trouble" | tail -20
        case $(head -1 "$dir/trouble") in skipped*) skipped=$((skipped + 1)) ;; *) failed=$((failed + 1)) ;; esac
        return
    fi
    for isa in $(cat "$dir/isas"); do
        if ! [ -e "$dir/$isa.txt" ]; then
            row "$1" "$isa" "DID NOT FINISH: $(tail -1 "$dir/$isa.err")"
            failed=$((failed + 1))
            continue
        fi
        if [ $compared -eq 0 ]; then
            compared=1
            if ! cmp -s "$dir/$isa.txt" "$want"; then
                # What is kept is of another state of the sources: whether all builds agree is still worth knowing.
                echo "  not the hashes kept: $(differing "$dir/$isa.txt")(make golden-update takes these)"
                want=$dir/$isa.txt
                failed=$((failed + 1))
            fi
        fi
        if cmp -s "$dir/$isa.txt" "$want"; then
            row "$1" "$isa" same
            passed=$((passed + 1))
        else
            row "$1" "$isa" "DIFFERS: $(differing "$dir/$isa.txt")$(tail -1 "$dir/$isa.err")"
            failed=$((failed + 1))
        fi
    done
}

native() {
    for cc in gcc clang; do
        for level in 0 2 3; do
            echo "$cc-O$level|$cc|-O$level|"
        done
    done
}
others() {
    for level in 0 2 3; do
        echo "aarch64-gcc-O$level|aarch64-linux-gnu-gcc|-O$level|qemu-aarch64"
    done
    echo "aarch64-clang-O2|clang --target=aarch64-linux-gnu|-O2|qemu-aarch64"
    # whole-program optimisation sees through the borders of files
    echo "gcc-O3-lto|gcc|-O3 -flto|"
    # -march=native brings FMA, which must not be used
    echo "gcc-native|gcc|-O3 -march=native|"
    echo "clang-native|clang|-O3 -march=native|"
    for level in 0 3; do
        echo "i686-O$level|i686-linux-gnu-gcc|-O$level -msse2 -mfpmath=sse|qemu-i386"
    done
    # words of 32 bits, and the high byte first
    echo "armhf-O2|arm-linux-gnueabihf-gcc|-O2|qemu-arm"
    echo "riscv64-O2|riscv64-linux-gnu-gcc|-O2|qemu-riscv64"
    echo "ppc64le-O2|powerpc64le-linux-gnu-gcc|-O2|qemu-ppc64le"
    echo "ppc64-O2|powerpc64-linux-gnu-gcc|-O2|qemu-ppc64"
    echo "s390x-O2|s390x-linux-gnu-gcc|-O2|qemu-s390x"
    for level in 0 2 3; do
        echo "wasm-O$level|clang --target=wasm32-wasi|-O$level|node --no-warnings tools/ci/wasi.js"
    done
}

lines=${MATRIX:-$(native; [ -n "${FAST:-}" ] || others)}
printf '%s\n' "$lines" | BUILD=$BUILD xargs -d '\n' -P "$JOBS" -n 1 sh "$0"
for name in $(printf '%s\n' "$lines" | cut -d'|' -f1); do
    judge "$name"
done
echo
sed 's/^\([^ ]*\) \([^ ]*\) \(.*\)$/  \1 (\2 steps) \3/' "$want" | awk '{ printf "  %-24s %-14s %s\n", $1, $2 " " $3, $4 }'
echo "golden: $passed same, $failed not, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
