#!/usr/bin/env bash
# Proves every certified number again with `check.py`, sees that it would notice mistakes, and proves what the program certifies of drawn
# problems.
#
# Needs Python 3.11 with venv, a network for PyPI, and a Rust toolchain or, in IMMACULATE, a program that is built already. Where
# python-flint cannot be installed, a line says that this is left out.
set -euo pipefail
cd "$(dirname "$0")/../.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1 # the package of the crate is this tree

if ! python3 -m venv "$work/venv" || ! "$work/venv/bin/python" -m pip install --quiet --requirement tests/independent/requirements.txt; then
    echo "LEFT OUT  the independent verification: no virtual environment, or no python-flint from PyPI"
    exit 0
fi
for what in "" --self-test "--drawn 40"; do
    # shellcheck disable=SC2086 # an option and its argument, or nothing
    "$work/venv/bin/python" tests/independent/check.py $what
done
