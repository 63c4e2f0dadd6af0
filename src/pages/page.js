// Builds each chart when it comes into view. All share one x: a drag zooms all of them, a double click shows all again.
(() => {
  'use strict';
  const Y_AXIS_PX = 70;
  const FONT = '12px system-ui, sans-serif';
  const all = {min: +document.body.dataset.from, max: +document.body.dataset.to};
  const shown = {...all};
  const built = new Set();
  let zooming = false;

  const numbers = (packed) => {
    let steps = 0;
    return packed.v.map((d) => (d === null ? null : packed.o + packed.s * (steps += d)));
  };
  const text = (value) => (value == null ? '-' : String(+value.toPrecision(4)));

  const zoom = (min, max, from) => {
    if (zooming || (min === shown.min && max === shown.max)) return;
    zooming = true;
    Object.assign(shown, {min, max});
    for (const plot of built) if (plot !== from) plot.setScale('x', {min, max});
    zooming = false;
  };

  const clipped = (u, draw) => {
    const {ctx, bbox} = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    draw(ctx, bbox, (x) => u.valToPos(x, 'x', true));
    ctx.restore();
  };
  const drawBands = (spec) => (u) => clipped(u, (ctx, box, at) => {
    for (const [from, to, colour] of spec.bands) {
      ctx.fillStyle = colour;
      ctx.fillRect(at(from), box.top, Math.max(1, at(to) - at(from)), box.height);
    }
  });
  const drawMarks = (spec) => (u) => clipped(u, (ctx, box, at) => {
    ctx.font = FONT;
    ctx.strokeStyle = ctx.fillStyle = '#b00020';
    for (const [x, words] of spec.marks) {
      ctx.beginPath();
      ctx.moveTo(at(x), box.top);
      ctx.lineTo(at(x), box.top + box.height);
      ctx.stroke();
      const left = at(x) + ctx.measureText(words).width + 8 > box.left + box.width;
      ctx.textAlign = left ? 'right' : 'left';
      ctx.fillText(words, at(x) + (left ? -4 : 4), spec.lanes ? box.top + box.height - 8 : box.top + 12);
    }
  });
  const drawLanes = (spec) => (u) => clipped(u, (ctx, box, at) => {
    const height = box.height / spec.lanes.length;
    ctx.font = FONT;
    ctx.textBaseline = 'middle';
    ctx.textAlign = 'left';
    spec.lanes.forEach((lane, i) => {
      const top = box.top + i * height;
      for (const [from, to, words, colour] of lane.stretches) {
        const left = at(from), width = Math.max(1, at(to) - left);
        ctx.fillStyle = colour;
        ctx.fillRect(left, top + 2, width, height - 4);
        const visible = Math.max(left, box.left);
        if (words && ctx.measureText(words).width + 8 < left + width - visible) {
          ctx.fillStyle = '#1b1f24';
          ctx.fillText(words, visible + 4, top + height / 2);
        }
      }
    });
  });

  const data = (spec) => {
    const tables = spec.tracks.map((track) => [numbers(track.x), ...track.y.map(numbers)]);
    if (tables.length === 0) return [[all.min, all.max]];
    return tables.length === 1 ? tables[0] : uPlot.join(tables);
  };

  const options = (spec, width) => {
    const lanes = spec.lanes;
    const grid = {stroke: '#e6e9ed', width: 1}, ticks = {stroke: '#c9ced6', width: 1, size: 4};
    const y = {stroke: '#1b1f24', font: FONT, size: Y_AXIS_PX, grid, ticks, values: (_, splits) => splits.map(text)};
    if (lanes) {
      const count = lanes.length;
      Object.assign(y, {
        splits: () => lanes.map((_, i) => count - i - 0.5),
        values: () => lanes.map((lane) => lane.name),
        grid: {show: false}, ticks: {show: false},
      });
    }
    return {
      width,
      height: lanes ? 34 + 26 * lanes.length : spec.height,
      legend: {show: !lanes, markers: {width: 0, fill: (u, i) => u.series[i].stroke()}},
      scales: {
        x: {time: false},
        y: lanes ? {range: () => [0, lanes.length]} : {},
      },
      series: [
        {label: spec.x_name, value: (_, v) => text(v) + ' ' + spec.x_unit},
        ...spec.lines.map((line) => ({
          label: line.name, stroke: line.colour, width: line.width, dash: line.dashed ? [6, 4] : undefined,
          paths: line.stepped ? uPlot.paths.stepped({align: 1}) : undefined,
          points: {show: false}, value: (_, v) => text(v),
        })),
      ],
      axes: [
        {stroke: '#1b1f24', font: FONT, grid, ticks, size: 26,
         values: (_, splits) => splits.map((v) => (v == null ? '' : `${+v.toFixed(6)} ${spec.x_unit}`))},
        y,
      ],
      cursor: {
        y: false,
        drag: {x: true, y: false},
        sync: {key: 'x', scales: ['x', null], filters: {pub: (type) => type === 'mousemove', sub: () => true}},
        bind: {dblclick: (u) => () => { u.setScale('x', {...all}); return null; }},
        points: {size: 6},
      },
      hooks: {
        drawClear: [drawBands(spec)],
        draw: [lanes ? drawLanes(spec) : () => {}, drawMarks(spec)],
        setScale: [(u, key) => { if (key === 'x') zoom(u.scales.x.min, u.scales.x.max, u); }],
      },
    };
  };

  const build = (place) => {
    const spec = JSON.parse(place.querySelector('script').textContent);
    zooming = true;
    const plot = new uPlot(options(spec, place.clientWidth), data(spec), place);
    plot.setScale('x', {...shown});
    requestAnimationFrame(() => { zooming = false; });
    built.add(plot);
    place.plot = plot;
    place.style.minHeight = '';
  };

  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      seen.unobserve(entry.target);
      build(entry.target);
    }
  }, {rootMargin: '300px'});
  const places = document.querySelectorAll('.chart');
  places.forEach((place) => seen.observe(place));

  let pending = 0;
  addEventListener('resize', () => {
    clearTimeout(pending);
    pending = setTimeout(() => places.forEach((place) => {
      if (place.plot && place.clientWidth > 0) place.plot.setSize({width: place.clientWidth, height: place.plot.height});
    }), 100);
  });
})();
