// A Raspberry Pi Pico with an ST7789, emulated by rp2040js, for tests/device and firmware/run.sh.
//
//   node run.mjs PROGRAM --serial SOCKET --monitor SOCKET
//
// SOCKET is the path of a Unix socket that someone listens at, or host:port. The serial one is UART 0. The monitor
// speaks as much of QEMU's QMP as is needed to look at the panel: `qmp_capabilities`, `screendump` (PNG) and `quit`.
//
// The emulator has no boot ROM: the processor starts at the program's vector table, as the boot loader would start it.
// An instruction takes the cycles that rp2040js counts; a byte on the panel's bus takes its bits at the bus' rate. The
// flash is as fast as RAM.

import { readFileSync, writeFileSync } from 'node:fs';
import { connect, createServer } from 'node:net';
import { ConsoleLogger, GPIOPinState, LogLevel, RP2040 } from 'rp2040js';

import { segments } from './elf.mjs';
import { png } from './png.mjs';
import { St7789 } from './st7789.mjs';

const FLASH = 0x10000000;
/** Behind the boot loader's second stage. */
const VECTORS = FLASH + 0x100;
/** Pins of the panel. */
const [DATA, SELECT, RESET] = [8, 9, 12];
/** Instructions between two looks at the sockets. */
const SLICE = 40_000;

function fail(reason) {
    process.stderr.write(`rp2040: ${reason}\n`);
    process.exit(2);
}

const [program, ...rest] = process.argv.slice(2);
const options = {};
for (let at = 0; at + 1 < rest.length; at += 2) options[rest[at]] = rest[at + 1];
if (!program || Object.keys(options).some((name) => !['--serial', '--monitor', '--listen'].includes(name))) {
    fail('usage: run.mjs PROGRAM [--serial SOCKET] [--monitor SOCKET] [--listen PORT]');
}

const chip = new RP2040();
chip.logger = new ConsoleLogger(LogLevel.Error, false);
for (const { address, bytes } of segments(readFileSync(program))) {
    if (address < FLASH || address - FLASH + bytes.length > chip.flash.length) {
        fail(`${program} has a segment at ${address.toString(16)}, which is not in the flash`);
    }
    chip.flash.set(bytes, address - FLASH);
}
const { core, clock } = chip;
core.VTOR = VECTORS;
core.reset();
core.BXWritePC?.(core.PC);
chip.onBreak = (code) => fail(`the program stopped at a breakpoint, ${code}`);

// --- the panel on SPI 1 ----------------------------------------------------------------------------------------------

const panel = new St7789();
const bus = chip.spi[1];
const isHigh = (pin) => chip.gpio[pin].value === GPIOPinState.High;
const sent = clock.createAlarm(() => bus.completeTransmit(0));
bus.onTransmit = (byte) => {
    if (!isHigh(SELECT)) panel.take(byte, isHigh(DATA));
    sent.schedule(bus.dataBits * 1e9 / bus.clockFrequency);
};
chip.gpio[RESET].addListener((state) => {
    if (state === GPIOPinState.Low) panel.reset();
});

// --- the line on UART 0 ----------------------------------------------------------------------------------------------

const line = chip.uart[0];
const incoming = [];
let outgoing = [];
let serial = null;
line.onByte = (byte) => outgoing.push(byte);

function talk(socket) {
    serial = socket;
    socket.on('data', (bytes) => incoming.push(...bytes));
    socket.on('close', () => { serial = null; });
    socket.on('error', () => { serial = null; });
}

/** As many bytes as the hardware holds: none is lost. */
function feed() {
    let taken = 0;
    while (taken < incoming.length && line.enabled && !line.rxFIFO.full) line.feedByte(incoming[taken++]);
    if (taken > 0) incoming.splice(0, taken);
}

function flush() {
    if (outgoing.length > 0 && serial) serial.write(Buffer.from(outgoing));
    outgoing = [];
}

// --- the monitor -----------------------------------------------------------------------------------------------------

function obey({ execute, arguments: given }) {
    switch (execute) {
        case 'qmp_capabilities': return { return: {} };
        case 'quit': process.exit(0);
        // eslint-disable-next-line no-fallthrough
        case 'screendump':
            if (panel.unknown > 0) {
                const name = panel.firstUnknown.toString(16);
                return { error: { desc: `the panel got ${panel.unknown} commands that it does not know, first ${name}` } };
            }
            writeFileSync(given.filename, png(panel.picture()));
            return { return: {} };
        default: return { error: { desc: `${execute} is no command of this emulator` } };
    }
}

function monitor(socket) {
    let begun = '';
    socket.write(`${JSON.stringify({ QMP: { version: {}, capabilities: [] } })}\n`);
    socket.on('data', (bytes) => {
        const lines = (begun + bytes).split('\n');
        begun = lines.pop();
        for (const text of lines) socket.write(`${JSON.stringify(obey(JSON.parse(text)))}\n`);
    });
    // Whoever started this has gone.
    socket.on('close', () => process.exit(0));
    socket.on('error', () => process.exit(0));
}

// --- the processor ---------------------------------------------------------------------------------------------------

let nanos = 1e9 / chip.clkSys;
chip.addClockListener(() => { nanos = 1e9 / chip.clkSys; });

function run() {
    for (let count = 0; count < SLICE; count += 1) {
        if (core.waiting) {
            // Asleep until something happens. rp2040js wakes a processor by interrupts of peripherals, not by its tick.
            clock.tick(clock.nanosToNextAlarm);
            if (core.interruptsUpdated && core.checkForInterrupts()) core.waiting = false;
            count += 20;
        } else {
            clock.tick(core.executeInstruction() * nanos);
        }
        if (incoming.length > 0 && (count & 255) === 0) feed();
    }
    feed();
    flush();
    setImmediate(run);
}

const [serialPath, monitorPath] = [options['--serial'], options['--monitor']];
if (serialPath) talk(connect(serialPath).on('error', () => fail(`nobody listens at ${serialPath}`)));
if (monitorPath) monitor(connect(monitorPath).on('error', () => fail(`nobody listens at ${monitorPath}`)));
if (options['--listen']) createServer(talk).listen(Number(options['--listen']), '127.0.0.1');
run();
