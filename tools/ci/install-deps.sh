#!/bin/sh
# Installs what the build needs beyond git, make and a C compiler. install-deps.sh [base|full|matrix]
#   base: cJSON for the tool, cmocka, libccd and Box2D for the tests
#   full: clang, the cross compilers, emulators and checkers that `make fuzz`, `make lint` and CI use
#   matrix: besides, the cross compilers of all machines that `make golden` compares
# Does nothing, and quickly, when all of it is there.
set -u
what=${1:-base}
CC=${CC:-gcc}

missing=
# need PACKAGE HEADER: by the header, so that libraries built by hand count too
need_header() {
    printf '#include <stddef.h>\n#include <stdarg.h>\n#include <stdint.h>\n#include <setjmp.h>\n#include <%s>\n' "$2" |
        $CC -E - >/dev/null 2>&1 || missing="$missing $1"
}
need_program() { command -v "$2" >/dev/null 2>&1 || missing="$missing $1"; }
need_file() { [ -e "$2" ] || missing="$missing $1"; }

need_header libcjson-dev cjson/cJSON.h
need_header libcmocka-dev cmocka.h
need_header libccd-dev ccd/ccd.h
if ls tests/*/*.cpp >/dev/null 2>&1; then
    need_program g++ g++
    [ -e /usr/include/box2d/box2d.h ] || [ -e /usr/local/include/box2d/box2d.h ] || missing="$missing libbox2d-dev"
fi
if [ "$what" = full ] || [ "$what" = matrix ]; then
    need_program g++ g++
    need_program pkg-config pkg-config
    need_program cmake cmake
    need_program clang clang
    need_program clang-format clang-format
    need_program lld wasm-ld
    need_program python3 python3
    need_program nodejs node
    need_program chromium chromium
    need_program valgrind valgrind
    need_program qemu-user qemu-aarch64
    need_program gcc-aarch64-linux-gnu aarch64-linux-gnu-gcc
    need_file libc6-dev-arm64-cross /usr/aarch64-linux-gnu/include/stdio.h
    need_program gcc-i686-linux-gnu i686-linux-gnu-gcc
    need_file libc6-dev-i386-cross /usr/i686-linux-gnu/include/stdio.h
    need_file wasi-libc /usr/lib/wasm32-wasi/libc.a
    # compiler-rt comes in a package a major version of clang
    major=$(clang -dumpversion 2>/dev/null | cut -d. -f1)
    major=${major:-$(apt-cache depends clang 2>/dev/null | sed -n 's/.*Depends: clang-\([0-9]*\)$/\1/p')}
    major=${major:-14}
    ls /usr/lib/llvm-"$major"/lib/clang/*/lib/wasi/libclang_rt.builtins-wasm32.a >/dev/null 2>&1 ||
        missing="$missing libclang-rt-$major-dev-wasm32"
    ls /usr/lib/llvm-"$major"/lib/clang/*/lib/linux/libclang_rt.fuzzer-x86_64.a >/dev/null 2>&1 ||
        missing="$missing libclang-rt-$major-dev"
fi
if [ "$what" = matrix ]; then
    need_program gcc-arm-linux-gnueabihf arm-linux-gnueabihf-gcc
    need_file libc6-dev-armhf-cross /usr/arm-linux-gnueabihf/include/stdio.h
    need_program gcc-riscv64-linux-gnu riscv64-linux-gnu-gcc
    need_file libc6-dev-riscv64-cross /usr/riscv64-linux-gnu/include/stdio.h
    need_program gcc-powerpc64-linux-gnu powerpc64-linux-gnu-gcc
    need_file libc6-dev-ppc64-cross /usr/powerpc64-linux-gnu/include/stdio.h
    need_program gcc-powerpc64le-linux-gnu powerpc64le-linux-gnu-gcc
    need_file libc6-dev-ppc64el-cross /usr/powerpc64le-linux-gnu/include/stdio.h
    need_program gcc-s390x-linux-gnu s390x-linux-gnu-gcc
    need_file libc6-dev-s390x-cross /usr/s390x-linux-gnu/include/stdio.h
fi
[ -n "$missing" ] || exit 0

root=
if [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
        root=sudo
    else
        echo "missing:$missing" >&2
        echo "install them with your package manager (the names are Debian's), then call make again" >&2
        exit 1
    fi
fi
if ! command -v apt-get >/dev/null 2>&1; then
    echo "missing:$missing" >&2
    echo "this is not a Debian or Ubuntu system: install their like with its package manager, then call make again" >&2
    exit 1
fi
echo "  installing$missing"
log=$(mktemp)
export DEBIAN_FRONTEND=noninteractive
for try in 1 2 3; do
    # shellcheck disable=SC2086
    if $root apt-get update >"$log" 2>&1; $root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends $missing >>"$log" 2>&1; then
        rm -f "$log"
        exit 0
    fi
    sleep "$try"
done
tail -20 "$log" >&2
echo "could not install:$missing" >&2
exit 1
