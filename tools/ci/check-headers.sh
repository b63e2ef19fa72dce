#!/bin/sh
# Whether each public header compiles alone, as C99 and as C++11.
set -u
CC=${CC:-gcc}
CXX=${CXX:-g++}
bad=0
for header in include/talus/*.h; do
    name=talus/$(basename "$header")
    printf '#include <%s>\ntypedef int nothing_else;\n' "$name" | $CC -std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -Iinclude -fsyntax-only -x c - || bad=1
    if command -v "${CXX%% *}" >/dev/null 2>&1; then
        printf '#include <%s>\ntypedef int nothing_else;\n' "$name" | $CXX -std=c++11 -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -Iinclude -fsyntax-only -x c++ - || bad=1
    fi
done
[ $bad -eq 0 ] && echo "  pass headers alone"
exit $bad
