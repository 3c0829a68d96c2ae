#!/usr/bin/env bash
# Proves every certified number again with `check.py`, and sees that it would notice mistakes.
#
# Needs Python 3.11 with venv, and a network for PyPI; where python-flint cannot be installed, a line says that this is left out.
set -euo pipefail
cd "$(dirname "$0")"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1 # the package of the crate is this tree

if ! python3 -m venv "$work/venv" || ! "$work/venv/bin/python" -m pip install --quiet --requirement requirements.txt; then
    echo "LEFT OUT  the independent verification: no virtual environment, or no python-flint from PyPI"
    exit 0
fi
"$work/venv/bin/python" check.py
"$work/venv/bin/python" check.py --self-test
