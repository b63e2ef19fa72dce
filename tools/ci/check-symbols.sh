#!/bin/sh
# What the library asks of the world outside, and whether it has any state of its own. check-symbols.sh LIBRARY
set -u
lib=$1
NM=${NM:-nm}
bad=0
# What a freestanding C compiler asks for by itself, and the square root that targets without an instruction call.
allowed='^(memcpy|memset|memmove|memcmp|sqrtf|_GLOBAL_OFFSET_TABLE_|__stack_chk_fail|__chkstk|__[a-z]*(di|si|ti|sf|df|tf)[a-z]*[0-9]?)$'
listing=$("$NM" -g "$lib") || exit 1
defined=$(echo "$listing" | awk 'NF == 3 && $2 != "U" { print $3 }' | sort -u)
echo "$listing" | awk '$1 == "U" || $2 == "U" { print $NF }' | sort -u | grep -vxF "$defined" | grep -vE "$allowed" | {
    while read -r symbol; do
        echo "  asks for $symbol: $("$NM" -gA "$lib" | grep " U $symbol\$" | sed 's/.*:\([^:]*\.o\):.*/\1/' | tr '\n' ' ')"
        exit 1
    done
} || bad=1
# d, b, c: writable data, its zeroed kind, and commons. Relocated read-only data (.data.rel.ro) shows as d: told apart below.
writable=$("$NM" -A "$lib" | awk '$(NF-1) ~ /^[dDbBcCsS]$/ { print $NF }')
for symbol in $writable; do
    if ! objdump -t "$lib" 2>/dev/null | grep -E "[.]data[.]rel[.]ro.* $symbol\$" >/dev/null; then
        echo "  writable global: $symbol"
        bad=1
    fi
done
# All that other files see has the prefix.
foreign=$(echo "$defined" | grep -vE '^(talus_|tl_)')
if [ -n "$foreign" ]; then
    echo "  names without the prefix: $foreign"
    bad=1
fi
[ $bad -eq 0 ] && echo "  pass symbols of $lib"
exit $bad
