// The part of an ST7789 that a program can see on its glass: the bytes of its serial interface in, a picture out.
//
// The glass has 240 columns and 320 rows and is mounted on its side, as on boards with 320 x 240 pixels. Like those it
// is an IPS panel: it shows each colour's complement until INVON is sent.

const COLUMNS = 240;
const ROWS = 320;

// Commands, as the controller's data sheet names them.
const SWRESET = 0x01;
const SLPIN = 0x10;
const SLPOUT = 0x11;
const NORON = 0x13;
const INVOFF = 0x20;
const INVON = 0x21;
const DISPOFF = 0x28;
const DISPON = 0x29;
const CASET = 0x2a;
const RASET = 0x2b;
const RAMWR = 0x2c;
const VSCRDEF = 0x33;
const MADCTL = 0x36;
const VSCSAD = 0x37;
const COLMOD = 0x3a;

// Bits of MADCTL: rows from the bottom, columns from the right, columns and rows exchanged, blue before red.
const MY = 0x80;
const MX = 0x40;
const MV = 0x20;
const BGR = 0x08;

/** 16 bits to the pixel. */
const RGB565 = 0x05;

export class St7789 {
    constructor() {
        this.memory = new Uint16Array(COLUMNS * ROWS);
        /** Commands that it does not know, and the first of them. */
        this.unknown = 0;
        this.firstUnknown = 0;
        this.reset();
    }

    /** What the reset pin and SWRESET do. The memory stays. */
    reset() {
        this.asleep = true;
        this.on = false;
        this.inverted = false;
        this.addressing = 0;
        this.bits = 0x06;
        this.columns = [0, COLUMNS - 1];
        this.rows = [0, ROWS - 1];
        this.command = 0;
        this.arguments = [];
        this.at = [0, 0];
        this.high = -1;
    }

    /** Width and height as the interface counts them. */
    get extent() {
        return this.addressing & MV ? [ROWS, COLUMNS] : [COLUMNS, ROWS];
    }

    /** Takes a byte; `data` is whether its D/C pin is high. */
    take(byte, data) {
        if (!data) this.begin(byte);
        else if (this.command === RAMWR) this.pixelByte(byte);
        else this.argument(byte);
    }

    begin(command) {
        this.command = command;
        this.arguments.length = 0;
        switch (command) {
            case SWRESET: this.reset(); break;
            case SLPIN: this.asleep = true; break;
            case SLPOUT: this.asleep = false; break;
            case INVOFF: this.inverted = false; break;
            case INVON: this.inverted = true; break;
            case DISPOFF: this.on = false; break;
            case DISPON: this.on = true; break;
            case RAMWR:
                this.at = [this.columns[0], this.rows[0]];
                this.high = -1;
                break;
            case NORON: case CASET: case RASET: case MADCTL: case COLMOD: case VSCRDEF: case VSCSAD: break;
            default:
                if (this.unknown === 0) this.firstUnknown = command;
                this.unknown += 1;
        }
    }

    argument(byte) {
        const given = this.arguments;
        given.push(byte);
        if (this.command === MADCTL) this.addressing = byte;
        if (this.command === COLMOD) this.bits = byte & 0x07;
        if (given.length === 4) {
            const range = [given[0] << 8 | given[1], given[2] << 8 | given[3]];
            if (this.command === CASET) this.columns = range;
            if (this.command === RASET) this.rows = range;
        }
    }

    pixelByte(byte) {
        // Pixels of another size come out as nothing: the picture will be seen to be wrong.
        if (this.bits !== RGB565) return;
        if (this.high < 0) {
            this.high = byte;
            return;
        }
        const pixel = this.high << 8 | byte;
        this.high = -1;
        const [x, y] = this.at;
        const [width, height] = this.extent;
        if (x < width && y < height) {
            let [column, row] = this.addressing & MV ? [y, x] : [x, y];
            if (this.addressing & MX) column = COLUMNS - 1 - column;
            if (this.addressing & MY) row = ROWS - 1 - row;
            this.memory[row * COLUMNS + column] = pixel;
        }
        // Column by column, then row by row, and from the start of the window again.
        if (x < this.columns[1]) this.at[0] = x + 1;
        else this.at = [this.columns[0], y < this.rows[1] ? y + 1 : this.rows[0]];
    }

    /** The picture: 320 x 240 pixels of three bytes; the 5 or 6 bits of a channel are the highest of its byte. */
    picture() {
        const [width, height] = [ROWS, COLUMNS];
        const bytes = new Uint8Array(width * height * 3);
        for (let y = 0, to = 0; y < height; y += 1) {
            for (let x = 0; x < width; x += 1, to += 3) {
                if (this.asleep || !this.on) continue;
                const stored = this.memory[x * COLUMNS + COLUMNS - 1 - y];
                const shown = this.inverted ? stored : stored ^ 0xffff;
                const channels = [shown >> 11 << 3, (shown >> 5 & 63) << 2, (shown & 31) << 3];
                if (this.addressing & BGR) channels.reverse();
                bytes.set(channels, to);
            }
        }
        return { width, height, bytes };
    }
}
