//! The file of a network.
//!
//! Little-endian, read in place: a header, for each input its offset, gain and
//! H weights, H biases, for each output its H weights, O biases (all f32), and
//! the CRC-32 of all before it.

use zerocopy::little_endian::U16;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::error::MlpError;
use super::limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS, MLP_VERSION};
use tactile::{CRC_BYTES, checksum};

const MAGIC: [u8; 4] = *b"WMLP";

#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct Header {
    magic: [u8; 4],
    version: U16,
    inputs: U16,
    hidden: U16,
    outputs: U16,
}

/// Refuses a shape outside the limits.
pub(super) const fn check_shape(
    inputs: usize,
    hidden: usize,
    outputs: usize,
) -> Result<(), MlpError> {
    if inputs == 0 || inputs > MAX_INPUTS {
        return Err(MlpError::Inputs(inputs));
    }
    if hidden == 0 || hidden > MAX_HIDDEN {
        return Err(MlpError::Hidden(hidden));
    }
    if outputs < 2 || outputs > MAX_OUTPUTS {
        return Err(MlpError::Outputs(outputs));
    }
    Ok(())
}

/// The numbers' bytes of a file that holds a network of this shape.
pub(super) fn body(
    bytes: &[u8],
    inputs: usize,
    hidden: usize,
    outputs: usize,
) -> Result<&[u8], MlpError> {
    // The smallest file: the header and the checksum.
    let expected = size_of::<Header>() + CRC_BYTES;
    let short = MlpError::Length {
        expected,
        found: bytes.len(),
    };
    let (header, _) = Header::ref_from_prefix(bytes).map_err(|_| short)?;
    if header.magic != MAGIC {
        return Err(MlpError::BadMagic);
    }
    if header.version.get() != MLP_VERSION {
        return Err(MlpError::UnknownVersion(header.version.get()));
    }
    let found = [header.inputs, header.hidden, header.outputs].map(|n| usize::from(n.get()));
    if found != [inputs, hidden, outputs] {
        return Err(MlpError::Shape {
            inputs: found[0],
            hidden: found[1],
            outputs: found[2],
        });
    }
    let (covered, crc) = bytes.split_last_chunk::<CRC_BYTES>().ok_or(short)?;
    if checksum(covered) != u32::from_le_bytes(*crc) {
        return Err(MlpError::Checksum);
    }
    covered.get(size_of::<Header>()..).ok_or(short)
}

/// The file of a network whose shape is checked.
#[cfg(feature = "train")]
pub(super) fn write(
    inputs: usize,
    hidden: usize,
    outputs: usize,
    numbers: impl Iterator<Item = f32>,
) -> std::vec::Vec<u8> {
    // At most 4096 each.
    let header = Header {
        magic: MAGIC,
        version: MLP_VERSION.into(),
        inputs: (inputs as u16).into(),
        hidden: (hidden as u16).into(),
        outputs: (outputs as u16).into(),
    };
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend(numbers.flat_map(f32::to_le_bytes));
    let crc = checksum(&bytes);
    bytes.extend(crc.to_le_bytes());
    bytes
}
