cd /tmp/pmg && tar xJf eval.tar.xz && tar xzf clips4.tgz; export OMP_NUM_THREADS=1
E="timeout 170 ev/bin/pmg_eval"; V="--variation randomization.yaml"; C="--clips lib4"; mkdir -p o
$E table1 --policy pmg=lead.onnx $V $C --jobs 20 --out o/table1 > o/table1.txt 2>&1
(for p in lead p4 without_gco; do $E gait --policy pmg=$p.onnx $C --jobs 1 --out o/gait_$p > o/gait_$p.txt 2>&1; done; $E steady --policy pmg=lead.onnx $C --jobs 3 --out o/steady > o/steady.txt 2>&1) &
$E push --policy pmg=lead.onnx $C --strengths 35,50 --jobs 14 --out o/push > o/push.txt 2>&1
$E jumps --policy pmg=lead.onnx $C $V --jobs 16 --out o/jumps > o/jumps.txt 2>&1
$E table1 --policy pmg=lead.onnx $V $C --scenario ev/share/pmg/scenarios/table1.yaml --jobs 16 --out o/gentle > o/gentle.txt 2>&1
$E table1 --policy pmg=p4.onnx --policy without_gco=without_gco.onnx $V $C --jobs 16 --out o/table1_others > o/table1_others.txt 2>&1
$E robust --policy pmg=lead.onnx $C --jobs 16 --out o/robust > o/robust.txt 2>&1
wait
