#!/bin/sh
# Runs the tool's own scenes and prints where their time goes. bench.sh TOOL [SCENE...]
set -eu
tool=$1
shift
[ $# -gt 0 ] || set -- $("$tool" scene --list | awk '{ print $1 }')

echo "ms a step, of each step the least of five runs; narrow, rows, solve are its largest stages;"
echo "overlap, joint: the worst errors of the second half, mm; MiB: the world's block; asleep: the share of bodies at rest"
printf '%-10s %6s %6s %6s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s %7s %7s\n' \
    scene bodies joints steps mean p50 p99 p99.9 max narrow rows solve overlap joint MiB asleep
for scene; do
    # Both reports are one line of JSON; the first number of a name is the one meant.
    { "$tool" run "@$scene" --json; "$tool" profile "@$scene" --json; } | awk -v scene="$scene" '
        function number(name,  at) {
            at = match($0, "\"" name "\":[-0-9.e+]+")
            return at ? substr($0, at + length(name) + 3, RLENGTH - length(name) - 3) + 0 : 0
        }
        function stage(name,  at, head) {
            head = "\"name\":\"" name "\",\"mean\":"
            at = match($0, head "[-0-9.e+]+")
            return at ? substr($0, at + length(head), RLENGTH - length(head)) + 0 : 0
        }
        NR == 1 {
            steps = number("body_steps")
            errors = sprintf("%8.2f %8.2f %7.2f %6.0f%%", 1000 * number("overlap_m"), 1000 * number("joint_separation_m"),
                number("block_bytes") / 1048576, steps ? 100 * number("sleeping_body_steps") / steps : 0)
        }
        NR == 2 {
            printf "%-10s %6d %6d %6d %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %s\n", scene, number("bodies"),
                number("joints"), number("steps"), number("mean"), number("p50"), number("p99"), number("p999"),
                number("max"), stage("narrow"), stage("rows"),
                stage("velocity") + stage("solve") + stage("position") + stage("relax"), errors
        }'
done
