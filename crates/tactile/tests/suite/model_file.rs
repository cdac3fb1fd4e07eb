//! A model file is read back as it was written, and refused for the right
//! reason when anything is wrong with it.

use crate::common;
use tactile::name::NameError;
use tactile::{
    Aligned, Axis, Model, ModelBuf, ModelError, ModelParts, Quantiser, QuantiserError, Sequential,
    TableParts,
};

fn example() -> ModelBuf {
    common::model(3, 2, 5, 20, |bin, channel, class| {
        -((bin + 5 * channel + 10 * class) as f64) / 2.0
    })
}

/// The bytes with one change and a checksum that fits.
fn resealed(change: impl Fn(&mut Vec<u8>)) -> Result<ModelBuf, ModelError> {
    let mut bytes = example().as_bytes().to_vec();
    bytes.truncate(bytes.len() - 4);
    change(&mut bytes);
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&bytes);
    bytes.extend(crc.to_le_bytes());
    ModelBuf::from_bytes(&bytes)
}

#[test]
fn content_survives() {
    let buf = example();
    let model = buf.view();
    assert_eq!((model.classes(), model.channels()), (3, 2));
    assert_eq!((model.bins(1), model.block()), (Some(5), 20));
    assert_eq!((model.bins(2), model.touch_rule()), (None, None));
    assert_eq!(model.floors(0), None);
    assert!(!model.is_joint());
    let names: Vec<_> = model.names().collect();
    assert_eq!(names, ["class 0", "class 1", "class 2"]);
    assert_eq!((model.name(2), model.name(3)), (Some("class 2"), None));
    assert_eq!(model.quantiser(1).unwrap().high, 1000);
    assert!(model.quantiser(2).is_none());
    for (bin, channel, class) in [(0, 0, 0), (4, 1, 2), (2, 0, 1), (3, 1, 0)] {
        let expected = -((bin + 5 * channel + 10 * class) as f32) / 2.0;
        assert_eq!(model.log2_likelihood(channel, bin, class), Some(expected));
    }
    assert_eq!(model.log2_likelihood(0, 5, 0), None);
    assert_eq!(model.log2_likelihood(2, 0, 0), None);
    assert_eq!(model.log2_likelihood(0, 0, 3), None);
}

#[test]
fn the_header_is_laid_out_as_documented() {
    let buf = example();
    let b = buf.as_bytes();
    assert_eq!(b[..4], *b"WLIK");
    assert_eq!(b[4..12], [2, 0, 3, 2, 2, 0, 20, 0]);
    assert_eq!(b[12..16], (b.len() as u32).to_le_bytes());
    // No touches, no floors.
    assert_eq!(b[16..20], [0xff; 4]);
    assert_eq!(b[20..32], [0; 12]);
    // The second table: of samples, one axis, its rows five after the first's.
    let rows = (32 + 40 + 80 + 24) / 4;
    assert_eq!(b[112..116], [0, 1, 0, 0]);
    assert_eq!(b[116..120], (rows + 10_u32).to_le_bytes());
    // Channel 1, five bins, 1000 to 0 codes.
    assert_eq!(b[120..124], [1, 0, 4, 0]);
    assert_eq!(b[124..132], [0xe8, 3, 0, 0, 0, 0, 0, 0]);
    // Header, two channels, two tables, three names of seven bytes, ten rows of two words.
    assert_eq!(b.len(), 32 + 40 + 80 + 24 + 80 + 4);
}

#[test]
fn damage_is_named() {
    let good = example();
    let parse = |bytes: &[u8]| ModelBuf::from_bytes(bytes).unwrap_err();
    let b = good.as_bytes();
    assert_eq!(parse(&[]), ModelError::TooShort);
    assert_eq!(parse(&b[..15]), ModelError::TooShort);
    assert_eq!(parse(&b[..b.len() - 4]), ModelError::TooShort);
    assert_eq!(parse(&b[..b.len() - 1]), ModelError::TooShort);
    assert_eq!(parse(&[b, &[0]].concat()), ModelError::TrailingBytes);
    assert_eq!(parse(&[b, &[0; 4]].concat()), ModelError::TrailingBytes);
    assert_eq!(parse(b"label,trial,x,y\nice,0,1,2\n"), ModelError::BadMagic);

    let set = |at: usize, value: u8| resealed(|b| b[at] = value).unwrap_err();
    assert_eq!(set(4, 1), ModelError::UnknownVersion(1));
    assert_eq!(set(6, 1), ModelError::Classes(1));
    assert_eq!(set(6, 33), ModelError::Classes(33));
    assert_eq!(set(7, 0), ModelError::Channels(0));
    assert_eq!(set(7, 25), ModelError::Channels(25));
    assert_eq!(set(8, 0), ModelError::Tables(0));
    assert_eq!(set(9, 23), ModelError::Tables(25));
    assert_eq!(set(10, 0), ModelError::Block(0));
    assert_eq!(set(11, 64), ModelError::Block(64 * 256 + 20));
    // A gap or a gate without a limit, a limit with no gate that is one.
    assert_eq!(set(24, 1), ModelError::TouchRule);
    assert_eq!(set(28, 2), ModelError::Padding);
    // Counts within their ranges that do not add up.
    assert_eq!(set(28, 1), ModelError::Length);
    assert_eq!(set(6, 5), ModelError::Length);
    // Channel 1: its upper edge below the lower; its scale; a reserved byte.
    let quantiser = |reason| ModelError::Quantiser { channel: 1, reason };
    assert_eq!(set(32 + 20 + 15, 0x80), quantiser(QuantiserError::Reversed));
    assert_eq!(
        set(32 + 20 + 17, 4),
        quantiser(QuantiserError::Exponent(1024))
    );
    assert_eq!(set(32 + 20 + 18, 1), ModelError::Padding);
    // A name's letter.
    let (class, reason) = (0, NameError::Hidden('\n'));
    assert_eq!(
        set(32 + 40 + 80 + 3, b'\n'),
        ModelError::Name { class, reason }
    );
    // Table 1: its source, axes, rows, channel, bins, range, slope, unused axis.
    assert_eq!(set(112, 1), ModelError::Padding);
    assert_eq!(set(113, 3), ModelError::Padding);
    assert_eq!(set(116, 1), ModelError::Length);
    assert_eq!(set(120, 2), ModelError::Padding);
    assert_eq!(set(123, 16), ModelError::Bins(4096 + 5));
    assert_eq!(set(127, 0x80), quantiser(QuantiserError::Reversed));
    assert_eq!(set(132, 1), ModelError::Padding);
    assert_eq!(set(136, 1), ModelError::Padding);
    // Names: empty, not UTF-8, one that eats the next.
    assert_eq!(set(152, 0), ModelError::NameLength { class: 0 });
    assert_eq!(set(162, 0xff), ModelError::NameNotUtf8 { class: 1 });
    assert_eq!(set(168, 200), ModelError::Length);
    // A value where an odd row has a gap.
    assert_eq!(set(182, 1), ModelError::Padding);

    let mut flipped = b.to_vec();
    flipped[100] ^= 1;
    assert_eq!(parse(&flipped), ModelError::Checksum);
    assert_eq!(Model::linked(&flipped), Err(ModelError::Checksum));
    assert_eq!(Model::linked(b), Ok(good.view()));
}

/// What is not looked at in a linked model may say anything: it decides wrongly.
#[test]
fn a_wrong_content_that_was_not_checked_is_harmless() {
    let good = example();
    let (header, end) = (6, good.as_bytes().len() - 4);
    for at in (header..12).chain(16..end) {
        let mut bytes = good.as_bytes().to_vec();
        bytes[at] ^= 0xff;
        let crc = tactile::checksum(&bytes[..end]);
        bytes[end..].copy_from_slice(&crc.to_le_bytes());
        let words = bytes.as_chunks().0.iter();
        let words: Vec<u32> = words.map(|word| u32::from_le_bytes(*word)).collect();
        let model = Model::linked(bytemuck::cast_slice(&words)).unwrap();
        let codes = vec![500; model.channels()];
        let mut classifier = Sequential::new(model, common::threshold(0.9)).unwrap();
        for n in 0..100 {
            if n % 40 == 0 {
                classifier.touch(n);
            }
            classifier.push(&codes).unwrap();
        }
    }
}

#[test]
fn a_block_of_too_many_lookups_is_refused() {
    let result = resealed(|b| {
        b[7] = 7;
        b[10..12].copy_from_slice(&10_000_u16.to_le_bytes());
    });
    assert_eq!(result.unwrap_err(), ModelError::BlockTimesChannels(70_000));
}

#[test]
fn misaligned_bytes_are_refused_not_misread() {
    let buf = example();
    // Of four starts in a row one alone is aligned.
    let mut copies = vec![0; buf.as_bytes().len() + 8];
    let results = [0, 1, 2, 3].map(|at| {
        let place = &mut copies[at..at + buf.as_bytes().len()];
        place.copy_from_slice(buf.as_bytes());
        Model::parse(place).map(|m| m.classes())
    });
    let count = |of| results.iter().filter(|result| **result == of).count();
    let (good, bad) = (count(Ok(3)), count(Err(ModelError::Misaligned)));
    assert_eq!((good, bad), (1, 3));
}

#[test]
fn aligned_wrapper_aligns_included_bytes() {
    assert_eq!(align_of::<Aligned<[u8; 3]>>(), 4);
    // Any file will do: what matters is where it is put.
    let bytes = tactile::include_model!("common.rs");
    assert_eq!(bytes.as_ptr().align_offset(4), 0);
    assert_eq!(Model::parse(bytes).unwrap_err(), ModelError::BadMagic);
}

#[test]
fn what_could_not_be_read_is_not_written() {
    let names = ["a".to_owned(), "b".to_owned()];
    let axis = Axis::new(0, 2, [0, 10]);
    let tables = [TableParts::of_channel(&axis, &[1, 2, 3, 4])];
    let good = ModelParts {
        names: &names,
        block: 10_000,
        channels: &[Quantiser::of_codes(0, 10)],
        tables: &tables,
        ..ModelParts::default()
    };
    assert!(ModelBuf::new(&good).is_ok());
    let refused = |parts: ModelParts<'_>, error| {
        assert_eq!(ModelBuf::new(&parts).unwrap_err(), error);
    };
    refused(ModelParts { block: 0, ..good }, ModelError::Block(0));

    let more_bins = Axis { bins: 3, ..axis };
    let too_short = [TableParts::of_channel(&more_bins, &[1, 2, 3, 4])];
    // Of two tables that each could stand alone the sum is too much.
    let full = [TableParts::of_channel(&axis, &[1, 2, 3, u16::MAX]); 3];
    for (tables, error) in [
        (&too_short[..], ModelError::Length),
        (&[], ModelError::Tables(0)),
        (&full, ModelError::TableEntry),
    ] {
        refused(ModelParts { tables, ..good }, error);
    }

    let class = 1;
    let long = ["a".to_owned(), "b".repeat(256)];
    let forged = ["a".to_owned(), "x\r\nok stop".to_owned()];
    let reason = NameError::Hidden('\r');
    for (names, error) in [
        (&long[..], ModelError::NameLength { class }),
        (&forged, ModelError::Name { class, reason }),
        (&names[..1], ModelError::Classes(1)),
    ] {
        refused(ModelParts { names, ..good }, error);
    }
}
