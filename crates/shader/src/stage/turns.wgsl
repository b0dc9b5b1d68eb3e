// Rays in turns, for drivers that end loops early (see `is_cut_short`): the interpreter of a large field alone would use up
// what they allow.
//
// A ray is traced from the start in every turn. What the field said earlier is read from the ray's notes; the first question
// that they do not answer ends the turn: whatever follows is told 0, so that it ends soon, and is forgotten. Then all threads
// answer the questions of their rays together, in one place, so that a turn costs one evaluation however far apart the rays
// of a group are. Nothing else of a shader knows about this.

const ASKED_VALUE: u32 = 1u;
const ASKED_GRADIENT: u32 = 2u;
const ASKED_MARKS: u32 = 3u;
/// In place of the number of words: the ray is done.
const TRACED: u32 = 0xffffffffu;

/// What belongs to rays is woven: the number of words that are noted, the registers of an interpreted field, the notes.
var<private> note_first: u32;
var<private> note_stride: u32;
/// Words that there are, and those that were read.
var<private> note_count: u32;
var<private> note_read: u32;
/// What the notes do not answer: 0 for nothing yet.
var<private> asked: u32;
var<private> asked_at: vec3f;
var<private> asked_side: f32;

/// Whether the next question is answered, with so many words.
fn is_noted(kind: u32, p: vec3f, words: u32) -> bool {
    if (asked == 0u && note_read + words > note_count) {
        asked = kind;
        asked_at = p;
        asked_side = march_side;
    }
    return asked == 0u;
}

fn read_note() -> f32 {
    note_read += 1u;
    return bitcast<f32>(notes[note_first + (REGISTERS + note_read) * note_stride]);
}

fn write_note(value: f32) {
    note_count += 1u;
    if (REGISTERS + note_count < tile.notes) {
        notes[note_first + (REGISTERS + note_count) * note_stride] = bitcast<u32>(value);
    }
}

fn cell(i: u32) -> f32 {
    return bitcast<f32>(notes[note_first + (i + 1u) * note_stride]);
}

fn set_cell(i: u32, value: f32) {
    notes[note_first + (i + 1u) * note_stride] = bitcast<u32>(value);
}

/// Whether what follows is not the ray's.
fn gives_up() -> bool {
    return asked != 0u;
}

fn field(p: vec3f) -> f32 {
    if (!is_noted(ASKED_VALUE, p, 1u)) {
        return 0.0;
    }
    return read_note();
}

fn field_gradient(p: vec3f) -> vec4f {
    if (!is_noted(ASKED_GRADIENT, p, 4u)) {
        return vec4f();
    }
    let value = read_note();
    let x = read_note();
    let y = read_note();
    let z = read_note();
    return vec4f(value, x, y, z);
}

fn field_marks(p: vec3f) -> Marks {
    if (!is_noted(ASKED_MARKS, p, 8u)) {
        return Marks(-1.0, -1.0, -1.0, 0.0, vec4f());
    }
    let object = read_note();
    let first = read_note();
    let second = read_note();
    let share = read_note();
    let centre = read_note();
    let x = read_note();
    let y = read_note();
    let z = read_note();
    return Marks(object, first, second, share, vec4f(centre, x, y, z));
}

/// Asks the field, and notes what it says.
fn answer() {
    march_side = asked_side;
    if (asked == ASKED_VALUE) {
        write_note(asked_field(asked_at));
    }
    if (asked == ASKED_GRADIENT) {
        let said = asked_field_gradient(asked_at);
        write_note(said.x);
        write_note(said.y);
        write_note(said.z);
        write_note(said.w);
    }
    if (asked == ASKED_MARKS) {
        let said = asked_field_marks(asked_at);
        write_note(said.object);
        write_note(said.first);
        write_note(said.second);
        write_note(said.share);
        write_note(said.orbit.x);
        write_note(said.orbit.y);
        write_note(said.orbit.z);
        write_note(said.orbit.w);
    }
    if (asked != 0u) {
        // what was counted will be counted again
        counted = array<u32, 8>();
        notes[note_first] = note_count;
        atomicStore(&counters[17], 1u);
        if (REGISTERS + note_count >= tile.notes) {
            // a ray of so many questions is not traced at all
            atomicStore(&counters[16], 1u);
        }
    }
}

@compute @workgroup_size(8, 8, 1)
fn trace(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    frame = given_frame;
    tile = given_tile;
    if (id.x < tile.size.x && id.y < tile.size.y) {
        note_stride = tile.size.x * tile.size.y;
        note_first = id.y * tile.size.x + id.x;
        note_count = select(notes[note_first], 0u, tile.turn == 0u);
        if (note_count != TRACED) {
            let pixel = tile.corner + id.xy;
            let within = jitter(pixel, tile.index);
            var found = trace_ray(pixel, tile.index, pixel_ray(vec2f(pixel) + within, pixel, tile.index), vec3f(0.0, -1.0, FAR));
            if (asked == 0u) {
                if (frame.samples != 0u) {
                    found.place = pack2x16unorm(within);
                }
                samples[(pixel.y - frame.band.x) * frame.size.x + pixel.x] = found;
                counted[COUNT_RAYS] += 1u;
                notes[note_first] = TRACED;
            }
        }
    }
    answer();
    count_up(local);
}

// There are no cones.

@compute @workgroup_size(8, 8, 1)
fn cones_wide() {}

@compute @workgroup_size(8, 8, 1)
fn cones_narrow() {}
