// What lies over something else, is hidden by it, or is cut off, of all text and controls that
// can be seen.
// Areas that scroll may cut; text that is shortened on purpose has a title that tells it whole.
() => {
  const seen = e => { const s = getComputedStyle(e); const r = e.getBoundingClientRect(); return s.visibility !== 'hidden' && r.width > 1 && r.height > 1 && s.opacity !== '0' && !e.closest('[aria-hidden=true] svg') };
  const name = e => `${e.tagName.toLowerCase()}.${String(e.className.baseVal ?? e.className)} «${(e.getAttribute('aria-label') || e.textContent || '').trim().slice(0, 40)}»`;
  const clip = (e, r, text) => { let box = {left:r.left,top:r.top,right:r.right,bottom:r.bottom};
    for (let p = text ? e : e.parentElement; p; p = p.parentElement) { const s = getComputedStyle(p); if (s.overflow !== 'visible' || s.overflowX !== 'visible') { const b = p.getBoundingClientRect(); box = {left:Math.max(box.left,b.left),top:Math.max(box.top,b.top),right:Math.min(box.right,b.right),bottom:Math.min(box.bottom,b.bottom)}; } }
    return box; };
  const items = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let n = walker.nextNode(); n; n = walker.nextNode()) {
    const p = n.parentElement; if (!n.data.trim() || !p || p.closest('svg, .sr, script, style, .chart, option, [hidden], noscript') || !seen(p)) continue;
    const range = document.createRange(); range.selectNodeContents(n);
    for (const r of range.getClientRects()) if (r.width > 1 && r.height > 1) { const c = clip(p, r, true); if (c.right - c.left > 1 && c.bottom - c.top > 1) items.push({e:p, r:c, full:r, text:n.data.trim()}); }
  }
  for (const e of document.querySelectorAll('button, input, [role=slider], [role=switch], a[href], select')) if (seen(e) && !e.closest('svg,.sr')) { const r = e.getBoundingClientRect(); const c = clip(e, r); if (c.right - c.left > 1 && c.bottom - c.top > 1) items.push({e, r:c, full:r, control:true, text:name(e)}); }
  const faults = [];
  const shortened = e => { const s = getComputedStyle(e); return s.textOverflow === 'ellipsis' && !/flex|grid/.test(s.display) && e.closest('[title]') !== null; };
  const scrolls = e => { for (let p = e.parentElement; p; p = p.parentElement) { const s = getComputedStyle(p); if (/auto|scroll/.test(s.overflowX + s.overflowY)) return true; } return false; };
  for (const i of items) {
    if (scrolls(i.e) || (!i.control && shortened(i.e))) continue;
    if (i.full.left < -1 || i.full.right > innerWidth + 1 || i.full.bottom > innerHeight + 1 || i.full.top < -1) faults.push(`off the page: ${i.text} in ${name(i.e)}`);
    else if (i.full.right - i.r.right > 1.5 || i.r.left - i.full.left > 1.5 || i.full.bottom - i.r.bottom > 3 || i.r.top - i.full.top > 3) faults.push(`clipped: ${i.text} in ${name(i.e)}`);
  }
  for (let a = 0; a < items.length; a++) for (let b = a + 1; b < items.length; b++) {
    const [p, q] = [items[a], items[b]];
    const w = Math.min(p.r.right, q.r.right) - Math.max(p.r.left, q.r.left), h = Math.min(p.r.bottom, q.r.bottom) - Math.max(p.r.top, q.r.top);
    if (w <= 1.5 || h <= 2.5) continue;
    if (p.e.contains(q.e) || q.e.contains(p.e)) continue;
    if (p.e.closest('.tag, .hint, .panel, dialog, .toast') !== q.e.closest('.tag, .hint, .panel, dialog, .toast')) continue;
    faults.push(`overlap: ${p.text} in ${name(p.e)} / ${q.text} in ${name(q.e)}`);
  }
  // What floats may let the pointer through to the drawing, but not to what it hides.
  const through = [...document.querySelectorAll('.through')];
  for (const e of through) e.style.pointerEvents = 'auto';
  const layer = e => e.closest('.panel, dialog, .toast');
  const opaque = e => { const s = getComputedStyle(e); return s.backgroundColor !== 'rgba(0, 0, 0, 0)' || s.backgroundImage !== 'none'; };
  const hides = (e, i) => { for (let p = e; p && !p.contains(i.e); p = p.parentElement) if (opaque(p)) return true; return i.control; };
  for (const i of items) {
    if (getComputedStyle(i.e).pointerEvents === 'none' || i.e.disabled) continue;
    const { left, right, top, bottom } = i.r;
    if (Math.min(right - left, bottom - top) < 8) continue;
    const on = [[left + 4, top + 4], [right - 4, top + 4], [left + 4, bottom - 4], [right - 4, bottom - 4], [(left + right) / 2, (top + bottom) / 2]]
      .map(([x, y]) => document.elementFromPoint(x, y))
      .find(e => e && !e.contains(i.e) && !i.e.contains(e) && !(layer(e) && layer(e) !== layer(i.e)) && hides(e, i));
    if (on) faults.push(`covered: ${i.text} in ${name(i.e)} by ${name(on)}`);
  }
  for (const e of through) e.style.pointerEvents = '';
  return [...new Set(faults)];
}
