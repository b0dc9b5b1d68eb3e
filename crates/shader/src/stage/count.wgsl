// How often the field was evaluated, by stage.

const COUNT_PREPASS: u32 = 0u;
const COUNT_MARCH: u32 = 1u;
const COUNT_NORMAL: u32 = 2u;
const COUNT_OCCLUSION: u32 = 3u;
const COUNT_SHADOW: u32 = 4u;
const COUNT_MATERIAL: u32 = 5u;
const COUNT_RAYS: u32 = 6u;
const COUNT_HITS: u32 = 7u;

/// What this thread counted.
var<private> counted: array<u32, 8>;
