// From what threads counted to the sums of all, in 64 bits.

/// What this workgroup counted.
var<workgroup> group_counted: array<atomic<u32>, 8>;

/// Whether loops of this thread end before they are done. Some drivers leave every loop once a thread made so many turns in
/// all of them (llvmpipe: 65,535); then this one, which has two to make, ends after the first. No compiler knows the number.
fn is_cut_short() -> bool {
    let wanted = min(frame.size.x, 1u) + 1u;
    var turns = 0u;
    while (turns < wanted) {
        turns += 1u;
    }
    return turns < wanted;
}

/// Adds what all threads of the workgroup counted to the buffer. Every thread must come here.
fn count_up(local_index: u32) {
    if (is_cut_short()) {
        atomicStore(&counters[16], 1u);
    }
    for (var k = 0u; k < 8u; k++) {
        if (counted[k] != 0u) {
            atomicAdd(&group_counted[k], counted[k]);
        }
    }
    workgroupBarrier();
    if (local_index < 8u) {
        let n = atomicLoad(&group_counted[local_index]);
        if (n != 0u) {
            let low = atomicAdd(&counters[2u * local_index], n);
            if (low + n < low) {
                atomicAdd(&counters[2u * local_index + 1u], 1u);
            }
        }
    }
}
