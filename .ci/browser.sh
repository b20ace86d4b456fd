#!/usr/bin/env bash
# Gets the tests that look at pages the browser they need. `make test` and `.ci/run` both call it.
#
#   .ci/browser.sh [python]     with the package installed; .venv/bin/python if it is left out
#
# Where a Chromium or Chrome is found it does nothing. Else it installs Debian's `chromium`, if there are apt-get and
# the rights to use it (root, or sudo without a password). Where that cannot be done it still succeeds, and pytest
# skips those tests and says so; but not with CI=true, for which a missing browser is a failure.
#
# DQ_MARINE_INSTALL_CHROMIUM=no installs nothing.
set -uo pipefail
cd "$(dirname "$0")/.."
python=${1:-.venv/bin/python}

say() { printf 'dq-marine: %s\n' "$*" >&2; }

browser_found() { PYTHONPATH=tests "$python" -c 'from support import browser; raise SystemExit(not browser.present())'; }

may_install() {
    [ "${DQ_MARINE_INSTALL_CHROMIUM:-yes}" != no ] && command -v apt-get >/dev/null || return 1
    as_root=()
    [ "$(id -u)" -eq 0 ] && return 0
    as_root=(sudo -n)
    sudo -n true 2>/dev/null
}

apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=1 -o Acquire::http::Timeout=20 \
        -o Acquire::https::Timeout=20 -o DPkg::Lock::Timeout=120 "$@"
}

browser_found && exit 0
if may_install; then
    say "installing Chromium with apt-get, for the tests that look at pages"
    log=$(mktemp)
    apt update >"$log" 2>&1 && apt install -y --reinstall --no-install-recommends chromium >>"$log" 2>&1 ||
        say "Chromium could not be installed: $(tail -n 1 "$log")"
    rm -f "$log"
    browser_found && exit 0
fi
if [ "${CI:-}" = true ]; then
    say "there is no Chromium, and CI skips no test"
    exit 1
fi
