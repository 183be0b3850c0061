#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds with warnings as errors and runs the tests, with and without sanitizers, the format and
# clang-tidy.
#   scripts/test.sh         half an hour or more on two cores from a clean clone
#   scripts/test.sh --full  also: all tests under the sanitizers, clang-tidy on every folder, the
#                           paper's experiments, long fuzzing and soaks, benchmarks
# No test may skip for a missing package, or for missing data if the data folder exists.
# The last line is "N passed, N failed[, N skipped]"; the exit status is 0 if none failed.
set -uo pipefail
cd "$(dirname "$0")/.." || exit
full=false
case ${1:-} in
  "") ;;
  --full) full=true ;;
  *)
    sed -n '3,9s/^# //p' "$0" >&2
    exit 2
    ;;
esac

passed=0 failed=0 skipped=0
finish() {
  local line="$passed passed, $failed failed"
  ((skipped == 0)) || line+=", $skipped skipped"
  echo "$line"
  ((failed == 0 && passed > 0)) || exit 1
}
trap finish EXIT

# check NAME COMMAND...: a step that passes or fails as a whole.
check() {
  local name=$1 start=$SECONDS
  shift
  if "$@"; then
    passed=$((passed + 1))
    echo "== $name: passed ($((SECONDS - start)) s)"
  else
    failed=$((failed + 1))
    echo "== $name: FAILED ($((SECONDS - start)) s)"
    return 1
  fi
}

# build PRESET TARGET [CMAKE OPTION...]: configures and compiles, at low priority.
build() {
  local preset=$1 target=$2
  shift 2
  cmake --preset "$preset" "$@" >/dev/null &&
    nice -n 19 cmake --build --preset "$preset" --target "$target" -j "$(nproc)"
}

# count ATTRIBUTE FILE: a number of the <testsuite> of a JUnit file.
count() {
  tr '\n' ' ' <"$2" | sed -nE "s/.*<testsuite [^>]*[[:space:]]$1=\"([0-9]+)\".*/\1/p"
}

# run_tests PRESET [CTEST OPTION...]: runs the tests and adds their counts.
run_tests() {
  local preset=$1 start=$SECONDS junit=$PWD/build/$1/junit.xml
  shift
  rm -f "$junit"
  ctest --preset "$preset" -j "$(nproc)" --output-junit "$junit" "$@" >"build/$preset/ctest.log" 2>&1 ||
    sed -n '/\*\*\*Failed/,/^ *[0-9]*\/[0-9]* Test/p; /tests failed/,$p' "build/$preset/ctest.log"
  if [[ ! -s $junit ]]; then
    failed=$((failed + 1))
    tail -n 20 "build/$preset/ctest.log"
    echo "== tests ($preset): FAILED: ctest did not run"
    return 1
  fi
  local all fails skips
  all=$(count tests "$junit") fails=$(count failures "$junit")
  skips=$(($(count skipped "$junit") + $(count disabled "$junit")))
  passed=$((passed + all - fails - skips)) failed=$((failed + fails)) skipped=$((skipped + skips))
  echo "== tests ($preset): $((all - fails - skips)) passed, $fails failed, $skips skipped" \
    "($((SECONDS - start)) s)"
}

# test_ros: builds and tests the packages of ros/, and adds their counts.
test_ros() {
  local log=build/test_ros.log p=0 f=1 s=0
  scripts/test_ros.sh >"$log" 2>&1 || tail -n 30 "$log"
  read -r p f s <<<"$(sed -nE '$s/^([0-9]+) passed, ([0-9]+) failed(, ([0-9]+) skipped)?.*/\1 \2 \4/p' "$log")"
  passed=$((passed + ${p:-0})) failed=$((failed + ${f:-1})) skipped=$((skipped + ${s:-0}))
  echo "== ROS 2 packages: $(tail -n 1 "$log")"
}

page() { web/check_page.sh build/release/apps/penumbra/penumbra; }

# page_ended PROCESS: waits for a page() that runs beside other work.
page_ended() {
  local log=build/release/page.log
  wait "$1" || { grep -A12 '^not ok' "$log" || tail -n 30 "$log"; echo "all of it: $log"; false; }
}

# check_tidy FOLDERS [CMAKE OPTION...]: clang-tidy on the targets of folders joined by |. Sources are
# included into one another's unit here, so they count as headers. Each header alone is a compiler's
# matter (test_headers).
check_tidy() {
  local folders=$1
  shift
  cmake --preset tidy "$@" >/dev/null && cmake --build build/tidy --target viewer_page >/dev/null || return
  # The commands are GCC's.
  run-clang-tidy -quiet -extra-arg=-Qunused-arguments -j "$(nproc)" -p build/tidy -checks=-bugprone-suspicious-include \
    -header-filter="^$PWD/($folders)/" "^$PWD/(build/tidy/(?!tests/house/headers/))?($folders)/.*\.c(pp|xx)\$" \
    >build/tidy/tidy.log 2>/dev/null || { grep -E 'error:|warning:' build/tidy/tidy.log | sort -u; false; }
  local status=$?
  grep -q '^clang-tidy' build/tidy/tidy.log || { echo "clang-tidy looked at no file"; return 1; }
  return "$status"
}

# built_again: the packages have the same bits when they are built in another folder, at another time.
built_again() {
  local elsewhere status
  elsewhere=$(mktemp -d) || return
  git clone -q . "$elsewhere/penumbra" &&
    TZ=Pacific/Auckland CCACHE_DISABLE=1 "$elsewhere/penumbra/scripts/deb.sh" >/dev/null 2>&1 &&
    TZ=Pacific/Auckland CCACHE_DISABLE=1 "$elsewhere/penumbra/scripts/wheel.sh" >/dev/null 2>&1 &&
    (cd "$elsewhere/penumbra" && sha256sum build/deb/*.{deb,spdx.json} build/wheel/*) | sha256sum --quiet -c
  status=$?
  rm -rf "$elsewhere"
  return "$status"
}

# check_abi TAG: the libraries of TAG can be replaced by those of scripts/deb.sh, as abidiff sees them.
# Instances of templates of the standard library and of Eigen are not their interface.
check_abi() {
  local new old
  rm -rf build/abi
  git clone -q -b "$1" . build/abi && (cd build/abi && debian/rules build >/dev/null 2>&1) || return
  printf '[suppress_function]\nsymbol_name_regexp = %s\n' \
    '^_ZN?K?[RO]?(St|9__gnu_cxx|5Eigen|8penumbra6detail)' >build/abi/suppressions
  for new in build/deb/penumbra/build/deb-*/*/libpenumbra*.so.*.*.*; do
    old=$(echo build/abi/build/deb-*/*/"$(basename "${new%%.so.*}")".so.*.*.*)
    [[ -e $old ]] || continue  # a new library
    abidiff --no-added-syms --no-unreferenced-symbols --suppressions build/abi/suppressions \
      --headers-dir1 build/abi/penumbra --headers-dir2 penumbra "$old" "$new" || return
  done
}

groups=(build ros python sim research test web lint)
! $full || groups+=(bench docs deb)
check packages scripts/packages.sh --install "${groups[@]}" || exit

require=opengl,simulation
[[ ! -d ${PENUMBRA_DATA:-../shared/data} ]] || require+=,data
export PENUMBRA_REQUIRE=${PENUMBRA_REQUIRE-$require}

# GCC takes twice Clang's time for the tests; --full compiles them by both.
test_compiler=clang++
! $full || test_compiler=
# Every option is given, so that no cached choice in a build tree leaves anything out.
tests=(-DPENUMBRA_BUILD_TESTS=ON "-DPENUMBRA_TEST_COMPILER=$test_compiler" -DPENUMBRA_WARNINGS_AS_ERRORS=ON)
everything=("${tests[@]}" -DPENUMBRA_BUILD_APPS=ON -DPENUMBRA_BUILD_EXAMPLES=ON -DPENUMBRA_WITH_SIMULATION=ON
            -DPENUMBRA_WITH_DDS=ON
            -DPENUMBRA_BUILD_RESEARCH=$full -DPENUMBRA_WITH_PYTHON=ON -DPENUMBRA_WITH_AVX512=ON)
# The release tests run every SIMD target; the sanitizers run AVX2 and below.
avx512=-DPENUMBRA_WITH_AVX512=OFF
sanitizer_scope=("${tests[@]}" -DPENUMBRA_BUILD_APPS=OFF -DPENUMBRA_BUILD_RESEARCH=OFF
                 -DPENUMBRA_BUILD_EXAMPLES=OFF "$avx512")
benchmarks=-DPENUMBRA_BUILD_BENCHMARKS=OFF
# UBSan's checks of every pointer take a third of the compilation. ASan finds most of what they find.
undefined=bool,bounds,enum,float-cast-overflow,integer-divide-by-zero
undefined+=,return,shift,signed-integer-overflow,unreachable,vla-bound
tidy_scope=penumbra
unity=ON  # many sources at once
# AddressSanitizer watches the code that reads files or writes images, ThreadSanitizer the renderer's
# threads. Their trees hold only those rooms. Most rooms are tested in one tree.
asan_rooms=-DPENUMBRA_ROOMS='base;mesh;robot;time;camera;render;labels;poses;tracking;cloud;targets;pipeline'
tsan_rooms=-DPENUMBRA_ROOMS='base;mesh;robot;camera;render'
not_in_release=-DPENUMBRA_SKIP_TESTS='base;mesh;robot'
not_in_asan=-DPENUMBRA_SKIP_TESTS='time;camera;targets;tracking;pipeline;planning;fusion;house'
not_in_tsan=-DPENUMBRA_SKIP_TESTS='base;mesh;robot;time;camera;labels;targets;tracking;pipeline;planning;fusion;cloud;house'
if $full; then
  export PENUMBRA_FULL=1
  sanitizer_scope=("${everything[@]}")
  not_in_release=-DPENUMBRA_SKIP_TESTS=
  not_in_asan=$not_in_release not_in_tsan=$not_in_release
  asan_rooms=-UPENUMBRA_ROOMS tsan_rooms=-UPENUMBRA_ROOMS
  undefined=undefined
  unity=OFF
  benchmarks=-DPENUMBRA_BUILD_BENCHMARKS=ON
  tidy_scope+='|io|apps|sim|research|tests|examples|bench'
fi

check format scripts/format.sh --check
check "page is what its sources give" web/check_bundle.sh
check clang-tidy check_tidy "$tidy_scope" "${everything[@]}" "$benchmarks"
waiting=$(($(nproc) + 1))  # some tests wait for messages of others
page=
# Other tests cover the same.
once_more='^LiveRenderers[.]ADevice'
if $full; then once_more='^$'; fi
check "build (release)" build release all "${everything[@]}" "$not_in_release" "$benchmarks" \
  "-DCMAKE_UNITY_BUILD=$unity" && {
  $full || { page >build/release/page.log 2>&1 & page=$!; }
  run_tests release -j "$waiting" -E "$once_more"
}
if $full; then
  check "page in a browser" page
  check "docs" scripts/docs.sh build/docs/html build/release
  check "Debian packages" scripts/deb.sh
  check "wheel" scripts/wheel.sh
  check "packages have the same bits elsewhere" built_again
  if tag=$(git describe --tags --abbrev=0 2>/dev/null); then
    check "binary interface of $tag" check_abi "$tag"
  else
    skipped=$((skipped + 1))
    echo "== binary interface: skipped: no tag"
  fi
  check "headers alone" build release test_headers "${everything[@]}" "$benchmarks"
  check "a great bag is streamed" build/release/bench/mcap_benchmark 5
  if [[ -d ${PENUMBRA_DATA:-../shared/data} ]]; then
    check "pipeline benchmark runs" build/release/bench/pipeline_benchmark --benchmark_min_time=0.01
  else
    skipped=$((skipped + 1))
    echo "== benchmarks run: skipped: no data"
  fi
fi
test_ros
asan_is_built=false tsan_is_built=false
check "build (asan)" build asan all "${sanitizer_scope[@]}" "$asan_rooms" "$not_in_asan" \
  "-DPENUMBRA_SANITIZE=address,$undefined" &&
  asan_is_built=true
check "build (tsan)" build tsan threaded_tests "${sanitizer_scope[@]}" "$tsan_rooms" "$not_in_tsan" &&
  tsan_is_built=true
# Makes a whole recording again: takes minutes and adds no code.
made_again='^Example[.]IsReproducible$'
# ThreadSanitizer runs the threaded tests. More meshes of the same robots, more scenes in OpenGL and
# narrower vectors find nothing new.
scenes='Backends/(Bodies|ClosedForm|Coverage|NearPlane)[.].*'
many="AnyNumberGivesTheSameBits|RandomPosesAndCameras/.*_visual|$scenes/(gl|cpu_.*_threads[2-9])"
many+='|cpu_SSE4|RenderersMadeAndDropped'
# A single thread has no races, and one robot is enough for the threads.
one_thread='/(reference|gl|cpu_[A-Z0-9]+_threads1)|RobotAgainstEmbree|AgreementTest'
one_thread+='|GlEnvironment|Gl[.](FramesHold|DevicesTell|OnlyThe)'
one_thread+='|RenderersMadeAndDropped'
if $full; then many=$made_again one_thread=$made_again; fi
! $asan_is_built || run_tests asan -E "$many"
! $tsan_is_built || run_tests tsan -L threaded -E "$one_thread"
[[ -z $page ]] || check "page in a browser, beside these tests" page_ended "$page"
if $full; then
  seeds=build/fuzz/found/mcap
  mkdir -p "$seeds"
  check "files of the reference library" node build/release/reference/generate.mjs "$seeds"
  check "fuzzers" scripts/fuzz.sh 30
fi
