#!/bin/sh
# Makes all data again, with the commands of the folders' README files.
set -eu
cd "$(dirname "$0")/.."
grep -h '^cargo run' notebooks-data/*/README.md | sh -eux
