#!/usr/bin/env bash
# Checks every program of this folder and holds the verdicts to what they must be.
#
# Needs a Rust toolchain, Python with venv, and a network for PyPI. Octave, a C++ compiler, CMake and the libraries are installed with apt
# where that is possible; what is missing is left out with a line that says so. IMMACULATE may name a program that is built already.
set -euo pipefail
cd "$(dirname "$0")/../.."

adapters=tests/adapters
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# The cases that are short enough for a filter with a mistake not to run away.
short=()
for beginning in mixing likelihood combination update rule.cubature-5 step.n step.c step.s step.u steps chain.not missed wrap \
    converted unscented.unequal; do
    short+=(--case "$beginning")
done

immaculate() {
    if [ -n "${IMMACULATE:-}" ]; then "$IMMACULATE" "$@"; else cargo run --quiet --release --locked -- "$@"; fi
}

# Measurements that are converted, modes of unequal dimensions, and what must be refused there.
converted=(--case converted --case sustika2015 --case unscented.unequal --case rejected.range --case rejected.unknown.conversion)

# Problems of format 2.
format_2=(--case missing --case sensors --case changing --case steps.changing --case input --case heading --case extended)

# expect STATUS LINE… -- ARGUMENTS OF check…: the exit status, and parts of the report, each of which must be there. What is refused is
# refused in its class.
expect() {
    local status=$1 wanted=()
    shift
    while [ "$1" != "--" ]; do
        wanted+=("$1")
        shift
    done
    shift
    local title="$*"
    title=${title//"${short[*]}"/(short cases)}
    title=${title//"${converted[*]}"/(converted measurements and unequal dimensions)}
    title=${title//"${format_2[*]}"/(problems of format 2)}
    judged "check $title" "$status" "${wanted[@]}" -- immaculate check "$@"
}

# judged TITLE STATUS LINE… -- COMMAND…: the same of any command.
judged() {
    local title=${1//"$work/"/} status=$2 found=0 wanted=()
    shift 2
    while [ "$1" != "--" ]; do
        wanted+=("$1")
        shift
    done
    shift
    "$@" >"$work/report" 2>&1 || found=$?
    tr -s ' \n' ' ' <"$work/report" >"$work/words" # sentences are broken into lines
    local complaint=""
    [ "$found" -eq "$status" ] || complaint="exit status $found where $status is expected"
    for part in "${wanted[@]}"; do
        grep -qF -- "$part" "$work/words" || complaint="$complaint${complaint:+; }no \"$part\""
    done
    ! grep -qF "for another reason" "$work/words" || complaint="$complaint${complaint:+; }refused in another class"
    if [ -z "$complaint" ]; then
        echo "as expected  $title"
    else
        echo "NOT AS EXPECTED  $title: $complaint"
        cat "$work/report"
        failures=$((failures + 1))
    fi
}

left_out() {
    echo "LEFT OUT  $1"
}

# The program in a language that README.md prints.
printed() {
    sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/{/^\`\`\`/d;p}" README.md
}

# What its filter of one mode must come to.
printed_is_right() {
    expect 0 "RIGHT on what was judged: $1" "3 right of 3 cases" -- --flag one-mode "${@:2}"
}

# install COMMAND-OR-FILE PACKAGE…: whether it is there, or can be installed.
install() {
    local needed=$1
    shift
    is_there "$needed" && return 0
    local apt=(apt-get)
    [ "$(id -u)" -eq 0 ] || apt=(sudo -n apt-get)
    "${apt[@]}" update >/dev/null 2>&1 || true
    DEBIAN_FRONTEND=noninteractive "${apt[@]}" install -y --no-install-recommends "$@" >/dev/null 2>&1 || true
    is_there "$needed"
}

is_there() {
    case $1 in
    /*) [ -e "$1" ] ;;
    *) command -v "$1" >/dev/null 2>&1 ;;
    esac
}

python_filters() {
    local python="$work/venv/bin/python"
    if ! python3 -m venv "$work/venv" || ! "$python" -m pip install --quiet numpy filterpy==2.0.0; then
        left_out "numpy and FilterPy: no virtual environment, or no PyPI"
        return
    fi
    local numpy=("$python" "$adapters/numpy_imm.py")

    expect 0 "RIGHT: numpy example, double precision" -- -- "${numpy[@]}"
    expect 0 "RIGHT: numpy example, single precision" -- -- "${numpy[@]}" --single
    expect 0 "15 right of 15 cases" "4932 of 4932 values" -- "${converted[@]}" -- "${numpy[@]}"
    expect 0 "11 right, 4 skipped of 15 cases" "needs covariances with an inverse" -- "${converted[@]}" -- "${numpy[@]}" --form information
    for form in joseph inverse; do
        expect 0 "RIGHT: numpy example, double precision" -- -- "${numpy[@]}" --form "$form"
    done
    expect 0 "RIGHT, but otherwise" "another form" -- -- "${numpy[@]}" --form information
    for convention in angle_mean=vector square_root=cholesky-upper first_step=unmixed first_step=predicted log_likelihood=without-two-pi; do
        expect 0 "RIGHT: numpy example, double precision" -- -- "${numpy[@]}" --convention "$convention"
    done
    for level in posteriors combined; do
        expect 0 "RIGHT: numpy example, double precision" "Never shown:" -- -- "${numpy[@]}" --show "$level"
    done

    expect 0 "RIGHT: numpy example, double precision" "136 of 136 values" -- --problem "$adapters/formulas.json" -- "${numpy[@]}"
    # A search finds nothing in it, and a mistake in the smallest problem that shows it.
    local search=(--seed 3 --out "$work/found.json")
    expect 0 "FOUND NOTHING" "seed 3" -- --search 5 "${search[@]}" -- "${numpy[@]}"
    expect 0 "FOUND NOTHING" -- --search 5 "${search[@]}" --problem tests/adapters/automotive.json -- "$python" "$adapters/automotive_imm.py"
    while read -r mistake quantity size; do
        expect 1 "FOUND: $quantity is wrong" "to $size in" "($mistake; mistake)" -- --search 60 "${search[@]}" -- "${numpy[@]}" --mistake "$mistake"
        expect 1 "FAULT $quantity" -- --problem "$work/found.json" -- "${numpy[@]}" --mistake "$mistake"
    done <<'END'
mixed-spread-omitted mixed.covariance 1 step, 2 modes, 1 component, 1 measured
innovation-not-wrapped innovation 1 step, 1 mode, 2 components, 1 measured
last-likelihood-used-again mode_probabilities 2 steps, 2 modes, 1 component, 1 measured
END

    # A mistake, and the equation in which it is made.
    while read -r mistake quantity; do
        expect 1 "FAULT $quantity" "MOST LIKELY" "($mistake; mistake)" -- "${short[@]}" -- "${numpy[@]}" --mistake "$mistake"
    done <<'END'
transition-transposed predicted_mode_probabilities
transition-transposed-in-mixing mixing_probabilities
mixing-with-mode-probabilities-alone mixing_probabilities
mixing-skipped mixed.mean
mixed-spread-omitted mixed.covariance
covariances-not-mixed mixed.covariance
process-noise-omitted predicted.covariance
process-noise-doubled predicted.covariance
points-not-drawn-afresh innovation_covariance
points-from-rows-of-the-root predicted_measurement
cubature-5-weight-13 predicted.mean
converted-covariance-not-rotated converted_covariance
converted-covariance-cross-term-of-other-sign converted_covariance
measurement-noise-omitted innovation_covariance
measurement-noise-doubled innovation_covariance
innovation-not-wrapped innovation
measurement-of-the-mean predicted_measurement
gain-of-mixed-covariance gain
covariance-not-updated updated.covariance
determinant-omitted log_likelihood
exponent-without-half log_likelihood
likelihood-of-updated-residual log_likelihood
updated-with-old-probabilities mode_probabilities
prior-omitted mode_probabilities
probabilities-not-advanced mode_probabilities
last-likelihood-used-again mode_probabilities
combined-spread-omitted combined.covariance
combined-with-predicted-probabilities combined.mean
END
    # Modes with states of their own, and what is forgotten of a conversion.
    expect 0 "4 right of 4 cases" "615 of 615 values" -- --case states -- "${numpy[@]}"
    while read -r mistake quantity; do
        expect 1 "FAULT $quantity" "MOST LIKELY" "($mistake; mistake)" -- --case states -- "${numpy[@]}" --mistake "$mistake"
    done <<'END'
states-mixed-unconverted mixed.mean
state-conversion-jacobian-omitted mixed.covariance
state-conversion-covariance-not-added mixed.covariance
END
    # Modes that start from the combined estimate, or each from its own.
    expect 0 "4 right of 4 cases" -- --case gpb1 --case unmixed -- "${numpy[@]}"
    expect 1 "FAULT mixing_probabilities" "MOST LIKELY" "(common-start-mixed-by-the-chain; mistake)" -- --case gpb1 \
        -- "${numpy[@]}" --mistake common-start-mixed-by-the-chain
    # A chain in continuous time.
    expect 0 "2 right of 2 cases" -- --case rates --case sojourns -- "${numpy[@]}"
    for mistake in chain-by-an-euler-step sojourn-times-as-rates; do
        expect 1 "FAULT predicted_mode_probabilities" "MOST LIKELY" "($mistake; mistake)" -- --case rates --case sojourns \
            -- "${numpy[@]}" --mistake "$mistake"
    done
    expect 1 "MOST LIKELY, TWO AT ONCE" "(mixed-spread-omitted; mistake)" "(determinant-omitted; mistake)" \
        -- "${short[@]}" -- "${numpy[@]}" --mistake mixed-spread-omitted --mistake determinant-omitted

    automotive "$python" "$adapters/automotive_imm.py"
    filterpy "$python" "$adapters/filterpy_imm.py"
}

# A filter for a car, its models and Jacobians written by hand, on a problem of its own: right, and each mistake with its equation and name.
automotive() {
    local own=tests/adapters/automotive.json
    expect 0 "RIGHT: automotive example, double precision" "1488 of 1488 values" "every expected value is certified" -- --problem "$own" -- "$@"
    while read -r mistake quantity; do
        expect 1 "FAULT $quantity" "MOST LIKELY" "($mistake; mistake)" -- --problem "$own" -- "$@" --mistake "$mistake"
    done <<'END'
motion-jacobian-transposed motion_jacobian
motion-jacobian-at-the-prediction motion_jacobian
motion-jacobian-last-column-omitted motion_jacobian
measurement-jacobian-at-the-mixed-mean measurement_jacobian
bearing-jacobian-negated measurement_jacobian
motion-by-jacobian predicted.mean
measurement-by-jacobian predicted_measurement
motion-of-the-first-step predicted.mean
process-noise-of-the-first-step predicted.covariance
innovation-not-wrapped innovation
mixed-spread-omitted mixed.covariance
transition-transposed predicted_mode_probabilities
determinant-omitted log_likelihood
covariance-not-updated updated.covariance
combined-spread-omitted combined.covariance
END
}

# What is found in FilterPy 2.0.0.
filterpy() {
    local combined="(prediction-combined-with-old-probabilities; mistake)" stale="(points-not-drawn-afresh; mistake)"

    # What is right is right; the prediction is combined with the probabilities of the step before.
    expect 0 "RIGHT on what was judged: FilterPy" -- --case likelihood.e --case likelihood.g --case update --case steps.one -- "$@" kalman
    expect 1 "FAULT combined_prediction.mean" "MOST LIKELY" "$combined" -- --case mixing --case step --case far --case units -- "$@" kalman
    expect 0 "RIGHT on what was judged: FilterPy" -- --case update --case rule -- "$@" unscented
    # Three things in different cases, each named; and a density that drops dimensions, which has no name.
    expect 1 "MOST LIKELY, IN DIFFERENT CASES" "explains 7 of the 9 cases" "$combined" "(last-likelihood-used-again; mistake)" \
        "(vanishing-likelihoods-ignored; mistake)" -- -- "$@" unscented
    expect 1 "explains 37 of the 44 cases" "$combined" "(last-covariance-used-again; mistake)" "Unexplained: singular.innovation" \
        -- -- "$@" kalman
    # Without a detection the probabilities are updated all the same; likelihoods underflow; a mode that cannot be reached is NaN.
    expect 1 "FAULT mode_probabilities" -- --case missed.one -- "$@" kalman
    expect 1 "FAULT mode_probabilities" "MOST LIKELY, TWO AT ONCE" "$combined" -- --case outlier -- "$@" kalman
    expect 1 "STOPPED" "array must not contain infs or NaNs" -- --case chain.unreachable -- "$@" kalman
    # The points' root does not exist where an entry has no variance.
    expect 1 "STOPPED" "LinAlgError: 5-th leading minor of the array is not positive definite" -- --case unscented.unequal -- "$@" unscented
    # The density drops dimensions where S is nearly singular.
    expect 1 "FAULT log_likelihood" -- --case singular.innovation -- "$@" kalman
    # The cubature filter measures the points that it propagated.
    expect 1 "FAULT innovation_covariance" "MOST LIKELY" "$stale" -- --case update --case rule -- "$@" cubature-3
    # Extended filters: alone they are right. In an IMM there is what is in all of them; besides, angles in the state are averaged as
    # numbers, and another transition matrix acts a step late, which has no name and is found as a formula.
    expect 0 "RIGHT on what was judged: FilterPy" -- --case extended.one-mode --case exact.measurement.extended -- "$@" extended
    expect 1 "FAULT predicted_mode_probabilities" "explains 11 of the 16 cases" "$combined" "(last-likelihood-used-again; mistake)" \
        "(vanishing-likelihoods-ignored; mistake)" "(state-angles-as-numbers; mistake)" "Unexplained: changing.extended" \
        "previous transitionᵀ · previous mode_probabilities" \
        "extended.unreachable: step 1: ValueError: array must not contain infs or NaNs" -- -- "$@" extended
    # Its own class cannot be called by its own IMM.
    expect 1 "STOPPED" "TypeError: unsupported operand" -- --case extended.generic -- "$@" extended --as-it-is
    # The transition matrix as documented.
    expect 1 "FAULT predicted_mode_probabilities" "(transition-transposed; mistake)" "$combined" \
        -- --case step.n --case chain.not -- "$@" kalman --transition-as-documented
}

octave() {
    octave-cli --no-init-file --eval "addpath('$adapters/octave'); $*"
}

octave_filter() {
    if ! install octave-cli octave; then
        left_out "Octave: not installed"
        return
    fi
    octave "immaculate.run_folder('$work/problems', '$work/answers', example_filter())" >"$work/octave.log" 2>&1 || cat "$work/octave.log"
    expect 0 "RIGHT on what was judged: Octave example, double precision" -- --answers "$work/answers"
    expect 0 "16 right, 1 skipped of 17 cases" "4338 of 4479 values" -- --kind converted --answers "$work/answers"
    expect 0 "23 right, 6 skipped of 29 cases" "there are no formulas and no named models here" -- "${format_2[@]}" \
        --answers "$work/answers"

    printed octave >"$work/my_filter.m"
    octave "addpath('$work'); immaculate.run_folder('$work/problems', '$work/printed', my_filter())" >"$work/octave.log" 2>&1 || cat "$work/octave.log"
    printed_is_right mine --answers "$work/printed"

    # The same in a test of its own, the long table, another convention, a mistake and an error, on few cases.
    mkdir "$work/few"
    cp "$work"/problems/{mixing.two-modes,missing.kalman,sensors.extended,heading.extended}.*.json "$work/few"
    octave "immaculate.run_folder('$work/few', '$work/tables', example_filter('first_step', 'unmixed'), 'csv')" >"$work/octave.log" 2>&1 ||
        cat "$work/octave.log"
    expect 0 "4 right, 1 skipped of 5 cases" -- --case mixing.two --case missing.kalman --case sensors.ext --case heading.ext \
        --answers "$work/tables"
    test_octave 0 "4 Passed, 0 Failed, 1 Incomplete" -- "example_filter()"
    test_octave 0 "4 Passed, 0 Failed, 1 Incomplete" -- "mistaken_filter('another-turn')"
    test_octave 1 "0 Passed, 4 Failed, 1 Incomplete" "Verification failed in mixing.two-modes." \
        "predicted_mode_probabilities, step 1, (1,1): " "mixed.mean, step 1, mode 1 (constant velocity), (1,1): " \
        -- "mistaken_filter('transition-transposed')"
    test_octave 1 "combined.mean, step 1, (1,1): NaN is shown" -- "mistaken_filter('not-finite')"
    test_octave 1 "combined.covariance, step 1: it has the size [4 1], not [4 4]" -- "mistaken_filter('wrong-size')"
    test_octave 1 "no value is shown" -- "mistaken_filter('hidden')"
    test_octave 1 "it stopped: step 1: singular matrix" -- "mistaken_filter('stops')"
}

# The few cases as tests; the last argument is the filter.
test_octave() {
    local arguments=("${@:1:$#-1}") filter=${!#}
    judged "tests in Octave of $filter" "${arguments[@]}" octave "immaculate.test_folder('$work/few', $filter)"
}

cpp_filter() {
    if ! install g++ g++ || ! install cmake cmake || ! install /usr/include/nlohmann/json.hpp nlohmann-json3-dev ||
        ! install /usr/include/eigen3 libeigen3-dev; then
        left_out "C++: no compiler, no CMake, or not its libraries"
        return
    fi
    install /usr/include/gtest/gtest.h libgtest-dev || left_out "unit tests in C++: no GoogleTest"
    # The header is installed and found for the unit tests, and fetched for the program; all are built at the same time.
    local header="$work/header" found="$work/found" fetched="$work/fetched" quiet=(-DCMAKE_CXX_FLAGS=-Werror --log-level=ERROR)
    cmake -S "$adapters/cpp" -B "$header" "${quiet[@]}" -DCMAKE_INSTALL_PREFIX="$work/prefix" >/dev/null
    cmake --install "$header" >/dev/null
    cmake -S "$adapters/cpp/example" -B "$found" "${quiet[@]}" -DCMAKE_PREFIX_PATH="$work/prefix" \
        -DCMAKE_REQUIRE_FIND_PACKAGE_immaculate=ON >/dev/null
    cmake -S "$adapters/cpp/example" -B "$fetched" "${quiet[@]}" -DCMAKE_DISABLE_FIND_PACKAGE_immaculate=ON >/dev/null
    cmake --build "$fetched" --target imm >"$work/program.log" 2>&1 &
    local program=$!
    if [ -e /usr/include/gtest/gtest.h ]; then
        cmake --build "$header" >"$work/tests.log" 2>&1 && cmake --build "$found" --target imm-test >>"$work/tests.log" 2>&1 ||
            cat "$work/tests.log"
        judged "tests of immaculate.hpp" 0 "[ PASSED ]" -- "$header/header-test"
        export IMMACULATE_CASES="$work/problems"
        judged "tests in C++" 0 "[ PASSED ]" "[ SKIPPED ] 1 test" "there is one filter for all modes here" -- "$found/imm-test"
    fi
    wait "$program" || cat "$work/program.log"
    printed cpp >"$work/my_filter.cpp"
    g++ -std=c++17 -Wall -Wextra -Werror -I "$adapters/cpp" -isystem /usr/include/eigen3 "$work/my_filter.cpp" -o "$work/my_filter"
    printed_is_right "my filter" -- "$work/my_filter"
    local imm="$fetched/imm"
    expect 0 "RIGHT on what was judged: C++ example, double precision" -- -- "$imm"
    expect 0 "17 right of 17 cases" "4479 of 4479 values" -- --kind converted -- "$imm"
    expect 0 "29 right of 29 cases" -- "${format_2[@]}" -- "$imm"
    expect 0 "RIGHT: C++ example, double precision" "136 of 136 values" -- --problem "$adapters/formulas.json" -- "$imm"
    for convention in unmixed predicted; do
        expect 0 "RIGHT on what was judged: C++ example" -- --case step --case missed -- "$imm" "first_step=$convention"
    done
}

# What `immaculate init` writes is right as it stands, in each language whose tools are there.
templates() {
    local all="RIGHT on what was judged: my filter" python="$work/venv/bin/python" answers="$work/template-answers" language
    for language in python octave cpp rust; do
        judged "init $language" 0 "NEXT" "cd $work/$language" -- immaculate init "$language" "$work/$language"
        judged "init $language again" 2 "exists already and is not overwritten" -- immaculate init "$language" "$work/$language"
    done
    if has_numpy; then
        expect 0 "$all" -- -- "$python" "$work/python/my_filter.py"
        sed 's/ + np.outer(m - mean, m - mean)//' "$work/python/my_filter.py" >"$work/mistaken.py"
        expect 1 "(mixed-spread-omitted; mistake)" "(combined-spread-omitted; mistake)" -- "${short[@]}" -- "$python" "$work/mistaken.py"
    fi
    if is_there octave-cli; then
        octave-cli --no-init-file --eval \
            "addpath('$work/octave'); immaculate.run_folder('$work/problems', '$answers', my_filter())" >"$work/octave.log" 2>&1 ||
            cat "$work/octave.log"
        expect 0 "$all" -- --answers "$answers"
    fi
    if is_there g++ && is_there cmake && is_there /usr/include/nlohmann/json.hpp && is_there /usr/include/eigen3; then
        { cmake -S "$work/cpp" -B "$work/cpp/build" && cmake --build "$work/cpp/build"; } >"$work/cpp.log" 2>&1 || cat "$work/cpp.log"
        expect 0 "$all" -- -- "$work/cpp/build/my_filter"
    fi
    # The filter in Rust is judged by `cargo test --test templates`: here its manifest has what it needs.
    if cargo fetch --quiet --manifest-path "$work/rust/Cargo.toml" 2>/dev/null; then
        judged "the filter in Rust" 0 -- cargo check --quiet --offline --manifest-path "$work/rust/Cargo.toml" --target-dir "$work/rust/target"
    else
        left_out "the filter in Rust: its crates cannot be fetched"
    fi
}

# Whether the environment of the filters in Python is there.
has_numpy() { "$work/venv/bin/python" -c 'import numpy' 2>/dev/null; }

# The examples for CI are what their schemas ask for and do what they say, and readers of JUnit count what the verdict counts.
continuous_integration() {
    local tools="$work/tools/bin" ci=tests/adapters/templates/ci program
    if ! has_numpy || ! python3 -m venv "$work/tools" ||
        ! "$tools/pip" install --quiet check-jsonschema junitparser; then
        left_out "the examples for CI: no virtual environment, or no PyPI"
        return
    fi
    local schema=("$tools/check-jsonschema" --builtin-schema)
    judged "the workflow for GitHub" 0 "ok" -- "${schema[@]}" vendor.github-workflows $ci/github-workflow.yml
    judged "the action for GitHub" 0 "ok" -- "${schema[@]}" vendor.github-actions $ci/action.yml
    judged "the job for GitLab" 0 "ok" -- "${schema[@]}" vendor.gitlab-ci --data-transform gitlab-ci $ci/gitlab-ci.yml
    sed 's/runs-on/runson/' $ci/github-workflow.yml >"$work/wrong.yml"
    judged "a wrong workflow" 1 "'runs-on' is a required property" -- "${schema[@]}" vendor.github-workflows "$work/wrong.yml"

    # Their scripts, with this program and with this Python.
    program=${IMMACULATE:+$(realpath "$IMMACULATE")}
    mkdir "$work/bin"
    printf '#!/bin/sh\nexec %s "$@"\n' "${program:-cargo run --quiet --release --locked --manifest-path $PWD/Cargo.toml --}" >"$work/bin/immaculate"
    printf '#!/bin/sh\nexec %s "$@"\n' "$work/venv/bin/python" >"$work/bin/python3"
    chmod +x "$work/bin/immaculate" "$work/bin/python3"
    "$tools/python" - "$work" <<'END'
import sys
from pathlib import Path
from ruamel.yaml import YAML

load = lambda name: YAML(typ="safe").load(Path("tests/adapters/templates/ci", name))
job = load("gitlab-ci.yml")["judge-filter"]
step = load("action.yml")["runs"]["steps"][1]["run"]
for name, value in {"command": "python3 my_filter.py", "options": "--kind kalman", "folder": "verdict"}.items():
    step = step.replace("${{ inputs.%s }}" % name, value)
Path(sys.argv[1], "gitlab.sh").write_text("\n".join(job["script"]))
Path(sys.argv[1], "github.sh").write_text(step)
Path(sys.argv[1], "kept").write_text("\n".join([*job["artifacts"]["paths"], job["artifacts"]["reports"]["junit"]]))
END
    local here="cd '$work/python' && PATH='$work/bin':\$PATH GITHUB_STEP_SUMMARY='$work/summary.md'"
    judged "the script for GitLab" 0 "RIGHT on what was judged: my filter" -- bash -c "$here bash -e '$work/gitlab.sh' && ls \$(cat '$work/kept')"
    judged "the script for GitHub" 0 "RIGHT on what was judged: my filter" "verdict.html" -- \
        bash -c "$here bash -e '$work/github.sh' && ls verdict && head -n 1 '$work/summary.md' | grep '^### RIGHT'"

    immaculate check "${short[@]}" --junit "$work/junit.xml" -- "$work/venv/bin/python" "$work/mistaken.py" >"$work/verdict" || true
    local wrong all
    read -r wrong all <<<"$(tr '\n' ' ' <"$work/verdict" | sed -n 's/.* \([0-9]*\) wrong of \([0-9]*\) cases.*/\1 \2/p')"
    judged "JUnit" 0 "$all tests, $wrong failures" -- "$tools/python" -c "
from junitparser import JUnitXml
read = JUnitXml.fromfile('$work/junit.xml')
tests = [test for suite in read for test in suite]
failures = [test for test in tests if any('mixed-spread-omitted' in result.text for result in test.result)]
assert (read.tests, read.failures) == (len(tests), len(failures))
print(len(tests), 'tests,', len(failures), 'failures')"
}

immaculate cases copy "$work/problems" >/dev/null
python_filters
octave_filter
cpp_filter
templates
continuous_integration
[ "$failures" -eq 0 ] || {
    echo "$failures verdicts are not as expected"
    exit 1
}
