#!/usr/bin/env bash
# Replaces a test that this build does not have. $1: its name, $2: the reason.
. "$(dirname "$0")/skip.sh" "$1"
skip_all "$2"
