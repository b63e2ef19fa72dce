# Sourced by checks that make several: count WHAT STATUS tells of one, and adds it to `passed` or `failed`.
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
