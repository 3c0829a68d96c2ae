#!/usr/bin/env bash
# Builds the wheel, installs it into an empty environment, and holds it there to what README.md says: its four lines, the tests, the types.
# The source distribution is made, and must be whole.
#
# Needs a Rust toolchain, Python with venv, and a network for PyPI; what cannot be installed is left out with a line that says so.
set -euo pipefail
cd "$(dirname "$0")"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

left_out() {
    echo "LEFT OUT  $1"
    exit 0
}

python3 -c 'import sys; sys.exit(sys.version_info < (3, 9))' 2>/dev/null || left_out "python: there is no Python from 3.9 on"
python3 -m venv "$work/tools" >/dev/null 2>&1 || left_out "python: it has no venv"
"$work/tools/bin/pip" install --quiet 'maturin>=1.9,<2' mypy 2>/dev/null || left_out "python: maturin cannot be installed from PyPI"

# The crate's own target folder and profile, so that what the tests have built is not built again.
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-../target}"
CARGO_TARGET_DIR=$(mkdir -p "$CARGO_TARGET_DIR" && cd "$CARGO_TARGET_DIR" && pwd)
cargo fmt --check
[ "$(grep -m 1 '^version' Cargo.toml)" = "$(grep -m 1 '^version' ../Cargo.toml)" ] || { echo "the two versions differ" && exit 1; }
"$work/tools/bin/maturin" build --quiet --profile dev --interpreter python3 --out "$work/wheels"

# An empty environment: the wheel, and what it asks for. The lines are those that this README and the project's print.
python3 -m venv "$work/user"
"$work/user/bin/pip" install --quiet "$work"/wheels/*.whl
for readme in README.md ../README.md; do
    sed -n '/^```python$/,/^```$/{/^```/d;p}' "$readme" >"$work/example.py"
    (cd "$work" && "$work/user/bin/python" -W error example.py) | tail -n 4
done
"$work/user/bin/immaculate" --version

"$work/user/bin/pip" install --quiet pytest filterpy stonesoup==1.9.1 || left_out "python/tests: pytest, FilterPy and Stone Soup cannot be installed from PyPI"
(cd tests && "$work/user/bin/python" -m pytest -q -p no:cacheprovider)
"$work/tools/bin/mypy" --strict --python-executable "$work/user/bin/python" --ignore-missing-imports --cache-dir "$work/mypy" immaculate

# A build from source has everything that Cargo reads.
"$work/tools/bin/maturin" sdist --out "$work/source" 2>&1 | tail -n 1
tar -xzf "$work"/source/*.tar.gz -C "$work/source"
(cd "$work"/source/*/python && cargo metadata --locked --format-version 1 >/dev/null)
for file in LICENSE src/main.rs src/cli/mod.rs fixtures/cases/lock.json tests/adapters/templates/python/my_filter.py immaculate/py.typed python/src/lib.rs; do
    test -f "$work"/source/*/"$file" || { echo "the source distribution lacks $file" && exit 1; }
done
