#!/bin/sh
# Runs the tool's own scenes and prints where their time goes. bench.sh TOOL [SCENE...]
set -eu
tool=$1
shift
[ $# -gt 0 ] || set -- $("$tool" scene --list | awk '{ print $1 }')

echo "ms a step; narrow, rows, solve are its largest stages; overlap, joint: the worst errors of the second half, mm;"
echo "MiB: the world's block; asleep: the share of bodies at rest"
printf '%-10s %6s %6s %6s %8s %8s %8s %8s %8s %8s %8s %8s %8s %7s %7s\n' \
    scene bodies joints steps mean p50 p99 p99.9 narrow rows solve overlap joint MiB asleep
for scene; do
    # The report is one line of JSON; the first number of a name is the one meant.
    "$tool" run "@$scene" --json --profile | awk -v scene="$scene" '
        function number(name,  at) {
            at = match($0, "\"" name "\":[-0-9.e+]+")
            return at ? substr($0, at + length(name) + 3, RLENGTH - length(name) - 3) + 0 : 0
        }
        {
            solve = number("velocity") + number("solve") + number("position") + number("relax")
            steps = number("body_steps")
            printf "%-10s %6d %6d %6d %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.2f %8.2f %7.2f %6.0f%%\n", scene, number("bodies"),
                number("joints"), number("steps"), number("ms_per_step_mean"), number("ms_per_step_p50"),
                number("ms_per_step_p99"), number("ms_per_step_p999"), number("narrow"), number("rows"), solve, 1000 * number("overlap_m"), 1000 * number("joint_separation_m"), number("block_bytes") / 1048576,
                steps ? 100 * number("sleeping_body_steps") / steps : 0
        }'
done
