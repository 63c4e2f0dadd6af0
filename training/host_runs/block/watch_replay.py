import re,sys,math
def rides(f):
    out=[];cur=None;w=None
    for l in open(f,errors='replace'):
        if l.startswith('[ RUN'): cur=[]; out.append(cur)
        elif l.startswith('W '):
            v=l.split(); w=dict(m=float(v[3]),a=float(v[5]),var=float(v[7]),walk=int(v[9]),held=float(v[13]))
        elif l.startswith('BLIND'): w=None
        elif l.startswith('T ') and cur is not None:
            v=l.split(); cur.append((float(v[1]),float(v[3]),int(v[5]),float(v[7]),w))
    return out
def judge(R,share,thr,tau,least,lost=.25,lost_n=11):
    g=1-math.exp(-.01/tau); res=[];mins=[]
    for r in R:
        ws=1.;n=0;clear=None;zero=0;hang=None;lowest=9
        for t,c,h,q,w in r:
            if t<3.9: zero=0
            zero=zero+1 if c<.1 else 0
            if clear is None and t>3.9 and zero==10: clear=t-.09
            if w is None or not w['walk'] or t<1.9: ws=1.;n=0;continue
            s=share(w)
            if w['held']>.5: ws+=g*(max(s,least)-ws)
            n=n+1 if s<lost and w['held']>.5 else 0
            before = clear is None and zero==0
            if before and t<4.0: lowest=min(lowest,ws)
            if hang is None and t>3.9 and (ws<thr or n>=lost_n): hang=t
            if h and hang is None and t>3.9: hang=t+9  # main's rule acted before this one would
        res.append(round(hang-clear,2) if hang and clear else None); mins.append(lowest)
    return sorted(x for x in res if x is not None)[-6:],round(min(mins),2)
for p in('old','new'):
    R=rides(f'/tmp/s/lifts_{p}.txt'); print(p,len(R))
    for name,share in(('max',lambda w:max(w['m'],w['a'])),('mean',lambda w:.5*(w['m']+w['a'])),('asked',lambda w:w['a']),('.25m+.75a',lambda w:.25*w['m']+.75*w['a'])):
        for thr in(.69,.65,.6,.55): print('  ',name,thr,judge(R,share,thr,.25,.3))
