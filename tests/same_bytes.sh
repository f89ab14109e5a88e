#!/usr/bin/env bash
# The same bytes from the builds for glibc and for musl: the unloading of every preset that comes with the engine, as JSON,
# whose numbers are written to the last bit. Of the engine alone, which needs no C compiler for musl.
set -euo pipefail
cd "$(dirname "$0")/.."
target=x86_64-unknown-linux-musl

if [ "$(uname -m)" != x86_64 ]; then
    echo "same_bytes.sh: NOT RUN, this is no x86-64" >&2
    exit 0
fi
if [ ! -d "$(rustc --print sysroot)/lib/rustlib/$target" ] && ! rustup target add "$target"; then
    echo "same_bytes.sh: NOT RUN, the target $target cannot be had" >&2
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo run --locked --quiet -p pulloff-engine --example unload >"$work/glibc.json"
cargo run --locked --quiet -p pulloff-engine --example unload --target "$target" >"$work/musl.json"
presets=$(grep -c '^{' "$work/glibc.json")
if [ "$presets" -lt 15 ]; then
    echo "same_bytes.sh: only $presets presets were unloaded" >&2
    exit 1
fi
diff "$work/glibc.json" "$work/musl.json" >"$work/differences" || {
    head -n 20 "$work/differences"
    echo 'same_bytes.sh: the builds for glibc and musl do not agree' >&2
    exit 1
}
echo "same_bytes.sh: $presets unloadings, the same bytes from the builds for glibc and musl"
