#!/bin/sh
# Starts `stairwright ARGUMENTS` in the container, with the kernels compiled when the image was made.
# Numba reads its cache only where it can write, and the image may be read-only: hence the copy.
set -eu
if [ ! -d "$NUMBA_CACHE_DIR" ]; then
    cp -r /opt/stairwright/kernels "$NUMBA_CACHE_DIR"
fi
exec stairwright "$@"
