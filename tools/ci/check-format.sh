#!/bin/sh
# Whether clang-format leaves the tree as it is, and no line is over 120 columns. Column tables by hand stand between
# clang-format off and on.
set -u
bad=0
sources=$(sh tools/ci/sources.sh)
long=$(awk 'length($0) > 120 { printf "  %s:%d: %d columns\n", FILENAME, FNR, length($0) }' $sources)
[ -n "$long" ] && echo "$long" && bad=1
# Other versions of it have other tastes.
if clang-format --version 2>/dev/null | grep -q 'version 14[.]'; then
    for file in $sources; do
        if ! clang-format "$file" | cmp -s - "$file"; then
            echo "  not as clang-format has it: $file"
            bad=1
        fi
    done
else
    echo "  clang-format 14 is not here: only the columns were counted"
fi
[ $bad -eq 0 ] && echo "  pass format"
exit $bad
