#!/bin/sh
# Whether somebody else's project finds the library: installed by make and by CMake, found by pkg-config and find_package,
# and taken in as a subdirectory.
set -u
BUILD=$(realpath -m "${BUILD:-build}")
CC=${CC:-gcc}
dir=$BUILD/consumer
rm -rf "$dir"
mkdir -p "$dir"
bad=0

report() {
    if [ "$2" -eq 0 ]; then
        echo "  pass $1"
    else
        echo "  FAIL $1"
        tail -20 "$dir/log"
        bad=1
    fi
}

# use NAME PREFIX: build the consumer against what is installed there, in two ways
use() {
    pc=$(dirname "$(find "$2" -name talus.pc)")
    # shellcheck disable=SC2046
    (PKG_CONFIG_PATH=$pc && export PKG_CONFIG_PATH &&
        $CC -std=c99 tools/ci/consumer/main.c $(pkg-config --cflags --libs talus) -o "$dir/$1-pc" && "$dir/$1-pc") >"$dir/log" 2>&1
    report "$1, found by pkg-config" $?
    (cmake -S tools/ci/consumer -B "$dir/$1-cmake" -DCMAKE_PREFIX_PATH="$2" && cmake --build "$dir/$1-cmake" &&
        "$dir/$1-cmake/consumer") >"$dir/log" 2>&1
    report "$1, found by find_package" $?
}

make --no-print-directory install BUILD="$BUILD" PREFIX="$dir/by-make" >"$dir/log" 2>&1
report "installed by make" $?
use by-make "$dir/by-make"

(cmake -S . -B "$dir/tree" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$dir/by-cmake" &&
    cmake --build "$dir/tree" -j "$(nproc 2>/dev/null || echo 2)" && cmake --install "$dir/tree") >"$dir/log" 2>&1
report "installed by CMake" $?
use by-cmake "$dir/by-cmake"

mkdir -p "$dir/sub"
cp tools/ci/consumer/main.c "$dir/sub"
cat >"$dir/sub/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.13)
project(consumer C)
add_subdirectory($(pwd) talus)
add_executable(consumer main.c)
target_link_libraries(consumer talus::talus)
END
(cmake -S "$dir/sub" -B "$dir/sub/build" && cmake --build "$dir/sub/build" -j 2 && "$dir/sub/build/consumer") >"$dir/log" 2>&1
report "taken in by add_subdirectory" $?
exit $bad
