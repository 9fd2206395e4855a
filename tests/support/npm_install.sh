#!/bin/sh
# Installs in WORK_FOLDER the packages that the package-lock.json of FOLDER pins. They stay installed while the lock file is
# the same; then no network is needed.
#   npm_install.sh FOLDER WORK_FOLDER
set -eu
folder=$1
work=$2
mkdir -p "$work"
cmp -s "$folder/package-lock.json" "$work/installed.json" && exit 0
rm -f "$work/installed.json"
cp "$folder/package.json" "$folder/package-lock.json" "$work/"
cd "$work"
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
cp package-lock.json installed.json
