#!/usr/bin/env bash
# Runs all fuzz targets of a folder at the same time and says what came of it:
#
#   run_all.sh FOLDER SECONDS [OUT]
#
# FOLDER holds bin/, seeds/ and dictionaries/, as build.sh makes it; OUT (by default FOLDER/results) gets a folder
# for each target, the table summary.md, and results.tar.gz with the table, the findings and the smallest corpora that
# cover the same; MERGE_SECONDS (600) are spent on looking for these. CORES (by default all) are shared out. TARGETS (by default all) are names in bin/.
set -uo pipefail
folder=$(realpath "$1")
seconds=$2
merge_seconds=${MERGE_SECONDS:-600}
out=${3:-$folder/results}
mkdir -p "$out"
out=$(realpath "$out")
cores=${CORES:-$(nproc)}
targets=${TARGETS:-$(ls "$folder/bin")}

export RUST_BACKTRACE=0

# Most bytes of an input.
max_len() {
    case $1 in
        ply | image | obj | scene | render) echo 4096 ;;
        *) echo 16384 ;;
    esac
}

dictionary() {
    local name=$1
    case $1 in scene | render) name=toml ;; esac
    [ ! -f "$folder/dictionaries/$name.dict" ] || echo "-dict=$folder/dictionaries/$name.dict"
}

# Cores for each: an even share, and what is left over to those with most to look at.
n_targets=$(wc -w <<<"$targets")
share=$((cores / n_targets))
left=$((cores - share * n_targets))
[ "$share" -gt 0 ] || { share=1 left=0; }
workers() {
    local n=$share i=0
    for name in render pbrt gltf scene zscene image obj ply; do
        grep -qw "$name" <<<"$targets" || continue
        [ "$name" != "$1" ] || [ "$i" -ge "$left" ] || n=$((n + 1))
        i=$((i + 1))
    done
    echo "$n"
}

run() {
    local target=$1 to="$out/$1"
    mkdir -p "$to/corpus" "$to/findings" "$to/tmp"
    # Inputs longer than the limit would be cut off: seeds set it for themselves.
    local longest len
    longest=$(find "$folder/seeds/$target" -type f -printf '%s\n' | sort -n | tail -1)
    len=$(max_len "$target")
    [ "${longest:-0}" -le "$len" ] || len=$longest
    # shellcheck disable=SC2046
    (cd "$to" && TMPDIR="$to/tmp" "$folder/bin/$target" \
        -fork="$(workers "$target")" -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 \
        -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len="$len" \
        -artifact_prefix="$to/findings/" $(dictionary "$target") \
        "$to/corpus" "$folder/seeds/$target") >"$to/log.txt" 2>&1
    # The smallest corpus that covers the same.
    mkdir -p "$to/smallest"
    (cd "$to" && TMPDIR="$to/tmp" timeout "$merge_seconds" "$folder/bin/$target" -merge=1 -timeout=10 -rss_limit_mb=2048 -max_len="$len" \
        "$to/smallest" "$to/corpus" "$folder/seeds/$target") >"$to/merge.txt" 2>&1 ||
        cp -r "$to/corpus/." "$to/smallest/" # Too little time: all of it.
    (cd "$to" && "$folder/bin/$target" -runs=0 -timeout=10 -rss_limit_mb=2048 -max_len="$len" \
        -artifact_prefix="$to/tmp/" "$to/smallest") >"$to/replay.txt" 2>&1
    rm -rf "$to/tmp"
}

started=$SECONDS
for target in $targets; do
    run "$target" &
done
wait
wall=$((SECONDS - started))

{
    echo "$n_targets targets, $seconds seconds, $cores cores; with merging $wall seconds."
    echo
    echo "| target | workers | executions | per second | edges reached | of | corpus | findings |"
    echo "|---|--:|--:|--:|--:|--:|--:|--:|"
    for target in $targets; do
        to="$out/$target"
        last=$(grep -aE '^#[0-9]+: cov:' "$to/log.txt" | tail -1)
        runs=$(sed -E 's/^#([0-9]+):.*/\1/' <<<"$last")
        all=$(grep -ao '([0-9]* inline 8-bit counters)' "$to/replay.txt" "$to/log.txt" | head -1 | grep -o '([0-9]*' | tr -d '(')
        edges=$(grep -aoE 'INITED cov: [0-9]+' "$to/replay.txt" | grep -oE '[0-9]+' | tail -1)
        [ -n "$edges" ] || edges=$(sed -E 's/.*cov: ([0-9]+).*/\1/' <<<"$last")
        corpus=$(find "$to/smallest" -type f | wc -l)
        size=$(du -sb --apparent-size "$to/smallest" | cut -f1)
        findings=$(find "$to/findings" -type f | wc -l)
        echo "| $target | $(workers "$target") | ${runs:-0} | $((${runs:-0} / seconds)) | ${edges:-?} | ${all:-?} | $corpus files, $((size / 1024)) KiB | $findings |"
    done
    echo
    echo "Findings, by what they say first:"
    echo
    found=no
    for target in $targets; do
        grep -aE 'panicked at|ERROR: (AddressSanitizer|libFuzzer)' -A1 "$out/$target/log.txt" |
            grep -avE '^--$|^==[0-9]+== *$' | sed -E 's/thread .* panicked/panicked/; s/==[0-9]+==//; s/0x[0-9a-f]+/0x_/g; s/after [0-9]+ seconds/after some seconds/' |
            sort | uniq -c | sort -rn | head -40 | sed "s/^/- $target:/" && found=yes
    done
    [ "$found" = yes ] || echo "none"
} >"$out/summary.md"

cd "$out" || exit 1
# shellcheck disable=SC2086
tar -czf results.tar.gz summary.md $(for t in $targets; do echo "$t/findings" "$t/smallest"; done)
cat summary.md
ls -lh "$out/results.tar.gz"
