#!/bin/sh
# The C sources of the tree, one a line.
find include src platform tests tools -name '*.[ch]' -o -name '*.inl' -o -name '*.cpp' | sort
