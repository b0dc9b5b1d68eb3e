// From what threads counted to the sums of all, in 64 bits.

/// What this workgroup counted.
var<workgroup> group_counted: array<atomic<u32>, 8>;

/// Adds what all threads of the workgroup counted to the buffer. Every thread must come here.
fn count_up(local_index: u32) {
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
