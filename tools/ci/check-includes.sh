#!/bin/sh
# Whether the includes of src point down only:
#   world > stage > dynamics, collide > geom > base > simd; the public headers count as ground; host is never included.
set -u
awk '
function rank(path) {
    if (path ~ /^world\//) return 6
    if (path ~ /^stage\//) return 5
    if (path ~ /^dynamics\//) return 4
    if (path ~ /^collide\//) return 4
    if (path ~ /^geom\//) return 3
    if (path ~ /^base\//) return 2
    if (path ~ /^simd\//) return 1
    if (path ~ /^talus\//) return 0
    return -1
}
function library(path) { sub(/\/.*/, "", path); return path }
FNR == 1 { from = FILENAME; sub(/^(src|platform|include)\//, "", from) }
/^[ \t]*#[ \t]*include[ \t]*"/ {
    split($0, part, "\"")
    to = part[2]
    if (index(to, "/") == 0) to = library(from) "/" to
    if (rank(to) < 0) problem(to " is not a place to include from")
    else if (rank(from) == 0 && rank(to) != 0) problem("a public header includes " to)
    else if (rank(to) > rank(from)) problem("includes " to ", which stands above it")
    else if (rank(to) == rank(from) && library(to) != library(from)) problem("includes " to " beside it")
    next
}
/^[ \t]*#[ \t]*include[ \t]*</ {
    header = $0
    sub(/.*</, "", header); sub(/>.*/, "", header)
    allowed = header ~ /^(stddef|stdint|string|float|limits)\.h$/ || header ~ /^(math|arm_neon|wasm_simd128|.?.?mmintrin|immintrin)\.h$/
    if (!allowed) problem("includes <" header ">")
}
function problem(text) { printf "  %s:%d: %s\n", FILENAME, FNR, text; bad = 1 }
END { if (!bad) print "  pass includes"; exit bad }
' $(find src platform/simd include -name '*.[ch]' -o -name '*.inl' -path 'src/*')
