// What a linked program puts into memory.

/** The loaded segments of a 32-bit little-endian ELF file: where each goes, and its bytes. */
export function segments(file) {
    if (file.readUInt32BE(0) !== 0x7f454c46 || file[4] !== 1 || file[5] !== 1) {
        throw new Error('no 32-bit little-endian ELF file');
    }
    const [from, size, count] = [file.readUInt32LE(28), file.readUInt16LE(42), file.readUInt16LE(44)];
    const loaded = [];
    for (let number = 0; number < count; number += 1) {
        const head = from + number * size;
        const [kind, offset, , physical, length] = [0, 4, 8, 12, 16].map((at) => file.readUInt32LE(head + at));
        if (kind === 1 && length > 0) loaded.push({ address: physical, bytes: file.subarray(offset, offset + length) });
    }
    return loaded;
}
