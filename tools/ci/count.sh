# Sourced by checks that make several: count WHAT STATUS tells of one, and adds it to `passed` or `failed`; exits WITH NAME OPTION...
# of an exit status of "$tool" $subcommand, whose outputs it leaves in $dir/out and $dir/err.
passed=0
failed=0
count() {
    if [ "$2" -eq 0 ]; then
        passed=$((passed + 1))
        echo "  pass $1"
    else
        failed=$((failed + 1))
        echo "  FAIL $1"
    fi
}
exits() {
    want=$1
    name=$2
    shift 2
    "$tool" "$subcommand" "$@" >"$dir/out" 2>"$dir/err"
    got=$?
    [ $got -eq "$want" ] || cat "$dir/err"
    [ $got -eq "$want" ]
    count "$name: exit status $want" $?
}
