#!/usr/bin/env bash
cd /tmp/pmg/runs && for r in */; do r=${r%/}; echo "$r $(cat $r/exit_code 2>/dev/null): $(tail -n 1 $r/log | cut -c1-420)"; done
