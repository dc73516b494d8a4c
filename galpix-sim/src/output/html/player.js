// Play, pause and step through the films. Without this script the browser plays them as they are.
// An animated PNG is split into stills, which are drawn over each other as the format says.
'use strict';
(() => {
  const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
    for (let bit = 0; bit < 8; bit++) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
    return n;
  });
  const chunk = (name, data) => {
    const bytes = new Uint8Array(12 + data.length), view = new DataView(bytes.buffer);
    view.setUint32(0, data.length);
    for (let n = 0; n < 4; n++) bytes[4 + n] = name.charCodeAt(n);
    bytes.set(data, 8);
    let crc = ~0;
    for (let n = 4; n < 8 + data.length; n++) crc = crcTable[(crc ^ bytes[n]) & 255] ^ (crc >>> 8);
    view.setUint32(8 + data.length, ~crc);
    return bytes;
  };
  const split = bytes => {
    const view = new DataView(bytes.buffer), film = { shared: [], frames: [] };
    for (let at = 8; at < bytes.length; at += 12 + view.getUint32(at)) {
      const name = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
      const data = bytes.subarray(at + 8, at + 8 + view.getUint32(at)), word = n => view.getUint32(at + 8 + n);
      if (name === 'IHDR') film.header = data;
      else if (name === 'PLTE' || name === 'tRNS') film.shared.push(chunk(name, data));
      else if (name === 'fcTL') {
        const delay = 1000 * view.getUint16(at + 28) / (view.getUint16(at + 30) || 100);
        film.frames.push({ width: word(4), height: word(8), x: word(12), y: word(16), delay, over: data[25] === 1, parts: [] });
      } else if (name === 'IDAT') film.frames.at(-1).parts.push(chunk('IDAT', data));
      else if (name === 'fdAT') film.frames.at(-1).parts.push(chunk('IDAT', data.subarray(4)));
    }
    return film;
  };
  const still = (film, frame) => {
    const header = film.header.slice(), view = new DataView(header.buffer);
    view.setUint32(0, frame.width);
    view.setUint32(4, frame.height);
    const parts = [new Uint8Array([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', header), ...film.shared, ...frame.parts];
    return createImageBitmap(new Blob([...parts, chunk('IEND', new Uint8Array(0))], { type: 'image/png' }));
  };
  const mount = async (figure, image) => {
    const binary = atob(image.src.slice(image.src.indexOf(',') + 1));
    const film = split(Uint8Array.from(binary, letter => letter.charCodeAt(0)));
    const canvas = document.createElement('canvas'), context = canvas.getContext('2d');
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', image.alt);
    const shown = [];
    for (const frame of film.frames) {
      const bitmap = await still(film, frame);
      if (!frame.over) context.clearRect(frame.x, frame.y, frame.width, frame.height);
      context.drawImage(bitmap, frame.x, frame.y);
      shown.push(await createImageBitmap(canvas));
    }
    const controls = document.createElement('div');
    controls.className = 'controls';
    controls.innerHTML = '<button type="button"></button><input type="range" min="0" step="1" aria-label="picture"><output></output>';
    const [button, slider, place] = controls.children;
    slider.max = shown.length - 1;
    let at = 0, timer = 0;
    const show = n => {
      at = n;
      slider.value = n;
      place.textContent = `picture ${n + 1} of ${shown.length}`;
      context.drawImage(shown[n], 0, 0);
    };
    const play = on => {
      clearTimeout(timer);
      timer = on ? setTimeout(() => { show((at + 1) % shown.length); play(true); }, film.frames[at].delay) : 0;
      button.textContent = on ? 'Pause' : 'Play';
    };
    button.onclick = () => play(!timer);
    slider.oninput = () => { play(false); show(+slider.value); };
    show(0);
    play(!matchMedia('(prefers-reduced-motion: reduce)').matches);
    image.replaceWith(canvas);
    figure.querySelector('.wide').after(controls);
  };
  const watch = new IntersectionObserver(entries => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      watch.unobserve(target);
      const image = target.querySelector('img');
      image.decode().then(() => mount(target, image)).catch(() => {}); // the browser's own playing goes on
    }
  }, { rootMargin: '400px' });
  document.querySelectorAll('figure.film').forEach(figure => watch.observe(figure));
})();
