// SPDX-License-Identifier: Apache-2.0
// The one result type of rt_core: bad data is a value, never an exception.
#pragma once

#include <cstdint>

namespace palpate {

/// Why a call could not do what it was asked. Numbers are stable: they are only ever added to.
enum class [[nodiscard]] Status : std::uint16_t{
    ok = 0,

    // Images: what validate() refuses. 1 to 99.
    image_too_small = 1,       ///< fewer bytes than a header
    image_misaligned = 2,      ///< the first byte is not on a 64-byte boundary
    image_bad_magic = 3,       ///< not a Palpate image
    image_bad_version = 4,     ///< another major format version
    image_bad_byte_order = 5,  ///< written for the other byte order
    image_bad_size = 6,        ///< total_bytes differs from the bytes given (cut or padded)
    image_bad_hash = 7,        ///< SHA-256 of the content differs (damaged)
    image_bad_header = 8,      ///< a header field is out of its range or a reserved one not zero
    image_bad_section = 9,  ///< a section lies outside the image, overlaps, or has the wrong stride
    image_bad_level = 10,   ///< a level record is inconsistent
    image_bad_piece = 11,   ///< a piece refers outside its section or has a bad sphere
    image_bad_tree = 12,    ///< parent and child links do not form one tree
    image_bad_index = 13,   ///< a vertex, triangle or neighbour index is out of range
    image_bad_float = 14,   ///< a float is not finite or out of range
    image_missing_section = 15,  ///< the section an engine needs is not in the image
    image_over_limit = 16,       ///< the image exceeds a compiled-in capacity

    // Scenes and set-up. 100 to 199.
    bad_argument = 100,       ///< a null pointer, an empty scene, a number out of range
    not_enough_memory = 101,  ///< the memory given is smaller than required_bytes()
    bad_pose = 102,           ///< a pose is not finite or its quaternion not of unit length
    /// the settings may refine to levels that were left out of an image: s0 below its s0_min, a
    /// partner with smaller support areas than its partner_area, exact, or kappa; or as much detail
    /// as delta was left out of two bodies before baking, so that nothing is known of a contact
    image_too_coarse = 103,
    answer_too_old = 104,  ///< contacts are asked for on a thread of their own, and it has stopped
};

/// The name of a status, static storage, never null.
[[nodiscard]] const char* describe(Status s) noexcept;

}  // namespace palpate
