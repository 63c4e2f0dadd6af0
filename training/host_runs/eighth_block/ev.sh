t=$1
(seq 1 20 | sed "s/^/one_lift.sh $t /"; printf "one_walk.sh $t %s\n" "pmgb_seed_2 11" "pmg 13" "pmgb 19" "pmg_seed_2 17" "pmg_seed_2 4" "pmg_seed_2 8") | xargs -P 2 -L 1 bash -c 'cd /tmp/gpu17; ./$0 "$@"'
