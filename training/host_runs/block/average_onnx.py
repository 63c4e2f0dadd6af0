import onnx,sys,numpy as np,json
from onnx import numpy_helper
out,*ins=sys.argv[1:]
ms=[onnx.load(f) for f in ins]
base=ms[-1]
for k,init in enumerate(base.graph.initializer):
    vals=[numpy_helper.to_array({i.name:i for i in m.graph.initializer}[init.name]).astype(np.float64) for m in ms]
    if init.name=='scale': v=1/np.sqrt(np.mean([1/x**2 for x in vals],0))
    else: v=np.mean(vals,0)
    init.CopyFrom(numpy_helper.from_array(v.astype(np.float32),init.name))
# golden pairs anew
p=base.metadata_props[0]; meta=json.loads(p.value)
w={i.name:numpy_helper.to_array(i).astype(np.float64) for i in base.graph.initializer}
L=sum(1 for n in w if n.startswith('w'))
for g in meta['golden']:
    seen=np.array(g['observation']); h=np.clip((seen-w['mean'])*w['scale'],-8,8)
    for i in range(L):
        h=w[f'w{i}']@h+w[f'b{i}']
        if i<L-1: h=np.where(h>0,h,np.expm1(np.minimum(h,0)))
    g['action']=[float(x) for x in np.clip(h,-4,4)]
p.value=json.dumps(meta); onnx.save(base,out)
