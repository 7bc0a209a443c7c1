#!/usr/bin/env bash
# Builds the fuzz targets and packs them with their seeds and dictionaries, to be run by run_all.sh, here or on
# another machine with glibc:
#
#   fuzz/build.sh [SCENES]
#
# SCENES is a folder of pbrt scenes (any depth), which become further seeds. The result is fuzz/out/fuzz.tar.xz and
# the folder fuzz/out/fuzz that it is made of. Needs cargo-fuzz and a nightly toolchain.
set -euo pipefail
cd "$(dirname "$0")"
scenes=${1:-}
max_seed=50000

# libFuzzer is C++: with its library inside, the binaries need only glibc.
libstdcxx=$(dirname "$(g++ -print-file-name=libstdc++.a)")
# The code is safe Rust but for a few lines: the address sanitizer would find little and halves the speed.
CXXSTDLIB=static=stdc++ RUSTFLAGS="-L native=$libstdcxx" cargo +nightly fuzz build --sanitizer none

out=out/fuzz
rm -rf out/fuzz out/fuzz.tar.xz
mkdir -p "$out/bin" "$out/seeds" "$out/dictionaries"
cp run_all.sh "$out/"
cp dictionaries/*.dict "$out/dictionaries/"
for target in $(cargo +nightly fuzz list); do
    cp "target/x86_64-unknown-linux-gnu/release/$target" "$out/bin/"
    mkdir -p "$out/seeds/$target"
    [ ! -d "seeds/$target" ] || cp -r "seeds/$target/." "$out/seeds/$target/"
done

# What the repository has anyway: scenes, the guide's examples, pictures.
for target in scene render; do
    for file in ../scenes/*.toml ../scenes/*/*.toml; do
        [ "$(stat -c %s "$file")" -gt "$max_seed" ] || cp "$file" "$out/seeds/$target/"
    done
    for page in ../docs/*.md ../docs/guide/*.md; do
        awk -v to="$out/seeds/$target/$(basename "$page" .md)" \
            '/^```toml$/ { n++; file = to "-" n ".toml"; next } /^```/ { file = "" } file { print > file }' "$page"
    done
    # Parts of scenes become scenes.
    for file in "$out/seeds/$target"/*.toml; do
        grep -q camera "$file" || sed -i "1i format = 1\nname = 'part'\ncamera = { look_from = [0, 0, 9], look_at = [0, 0, 0], vfov_deg = 40, width = 4, height = 4 }" "$file"
    done
done
cp ../assets/gradient.pfm "$out/seeds/image/"

# Compiled scenes are those of this zrak only.
for file in "$out"/seeds/render/*.toml; do
    ZRAK_FUZZ_COMPILE="$out/seeds/zscene" "$out/bin/render" "$file" >/dev/null 2>&1 || true
done
find "$out/seeds/zscene" -size +"$max_seed"c -delete

# One input with all the files that a scene names, after lines `#file NAME`.
add_file_set() {
    local folder main name set="$2"
    folder=$(dirname "$1") main=$(basename "$1")
    cp "$1" "$set"
    chmod u+w "$set"
    # Twice, as included files name others.
    for _ in 1 2; do
        { grep -ao '"[^"]*\.\(pbrt\|ply\|spd\|gz\)"' "$set" || true; } | tr -d '"' | sort -u | while read -r name; do
            if [ -f "$folder/$name" ] && [ "$name" != "$main" ] && ! grep -aq "^#file $name\$" "$set"; then
                # Files that are too large, by their first lines.
                { printf '\n#file %s\n' "$name"; head -c $((max_seed / 4)) "$folder/$name"; } >>"$set"
            fi
        done
    done
    [ "$(stat -c %s "$set")" -le "$max_seed" ] || rm "$set"
}
if [ -n "$scenes" ]; then
    find "$scenes" -name '*.pbrt' -size -"$max_seed"c | while read -r file; do
        add_file_set "$file" "$out/seeds/pbrt/$(basename "$(dirname "$file")")-$(basename "$file")"
    done
    find "$scenes" -name '*.ply' -size -"$max_seed"c -exec cp -f {} "$out/seeds/ply/" \;
    find "$scenes" \( -name '*.png' -o -name '*.jpg' -o -name '*.exr' -o -name '*.hdr' \) -size -"$max_seed"c \
        -exec cp -f {} "$out/seeds/image/" \;
    chmod -R u+w "$out/seeds"
fi

echo "Shared libraries that the targets need:"
ldd "$out"/bin/* | awk '/=>/ { print $1 } /ld-linux/ { print $1 }' | sort -u
tar -C out -cJf out/fuzz.tar.xz fuzz
du -h out/fuzz.tar.xz
