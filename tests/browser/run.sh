#!/usr/bin/env bash
# Opens the pages of `immaculate report` in a real browser and gives them to the validator of HTML's authors, and sees that both notice a page
# that is wrong.
#
# Needs a Rust toolchain. Chromium is installed with apt where that is possible; the validator comes from npm and needs Java. What is
# missing is left out with a line that says so. IMMACULATE may name a program that is built already.
set -euo pipefail
cd "$(dirname "$0")/../.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

immaculate() {
    if [ -n "${IMMACULATE:-}" ]; then "$IMMACULATE" "$@"; else cargo run --quiet --release --locked -- "$@"; fi
}

left_out() { echo "LEFT OUT  $1"; }

judge() {
    if [ "$1" = "$2" ]; then
        echo "as expected  $3"
    else
        echo "NOT AS EXPECTED  $3"
        cat "$work/said"
        failures=$((failures + 1))
    fi
}

immaculate report --runs 2 --out "$work/site"
sed 's|</main>|<img src="http://127.0.0.1:9/seen"></main>|; s|default-src .none.; ||' "$work/site/index.html" >"$work/asking.html"
sed 's|</main>|<p id="content">again</main>|' "$work/site/index.html" >"$work/invalid.html"

# Whether a page asks the network for anything. The browser's own requests to its maker are not the page's.
asks() {
    chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking --disable-component-update \
        --disable-sync --user-data-dir="$work/profile-$2" --log-net-log="$work/net-$2.json" --dump-dom "file://$1" \
        >"$work/dom-$2.html" 2>/dev/null
    grep -q '</footer>' "$work/dom-$2.html" || { echo "not shown"; return; }
    grep -oE '"url":"(https?|wss?):[^"]*"' "$work/net-$2.json" | grep -vE '//[a-z0-9.-]+\.(google|googleapis|gstatic)\.com/' | sort -u >"$work/said" || true
    if [ -s "$work/said" ]; then echo yes; else echo no; fi
}

if ! command -v chromium >/dev/null && command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    apt-get install -y -qq chromium >/dev/null 2>&1 || { apt-get update -qq && apt-get install -y -qq chromium >/dev/null 2>&1; } || true
fi
if command -v chromium >/dev/null; then
    for page in "$work"/site/*.html; do
        name=$(basename "$page" .html)
        judge "$(asks "$page" "$name")" no "$name is shown and asks the network for nothing"
    done
    judge "$(asks "$work/asking.html" asking)" yes "a page that asks for a picture is noticed"
else
    left_out "the browser: there is no Chromium"
fi

# Whether the validator finds an error. `displaystyle` and `scriptlevel` belong on every element of MathML Core, which it does not know yet.
validates() {
    java -Xss8m -jar "$work/node_modules/vnu-jar/build/dist/vnu.jar" --errors-only --format gnu "$@" 2>&1 |
        grep -vE 'Attribute .(displaystyle|scriptlevel). not allowed on element' >"$work/said" || true
    if [ -s "$work/said" ]; then echo no; else echo yes; fi
}

if command -v java >/dev/null && command -v npm >/dev/null && npm install --silent --prefix "$work" vnu-jar@26.9.27 >/dev/null 2>&1; then
    judge "$(validates "$work"/site/*.html)" yes "the pages are valid HTML"
    judge "$(validates "$work/invalid.html")" no "a page with an anchor that stands twice is not"
else
    left_out "the validator: it needs Java, npm and its package"
fi

[ "$failures" -eq 0 ] || { echo "$failures not as expected"; exit 1; }
