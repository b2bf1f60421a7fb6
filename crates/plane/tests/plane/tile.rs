//! The bytes of tiles.

use stickslip_plane::sweep::{NO_COUNT, NO_EPS_T, Tile};

const LABEL: &str = "a map\ntile 3\n";

fn tile() -> Tile {
    Tile { eps_t: vec![0.5, NO_EPS_T, -1.0 / 3.0], switch_count: vec![4, NO_COUNT, i32::MAX] }
}

#[test]
fn reads_back_bit_for_bit() {
    let bytes = tile().to_bytes(LABEL);
    let read = Tile::from_bytes(&bytes, LABEL, 3).unwrap();
    assert_eq!(read.switch_count, tile().switch_count);
    let bits = |tile: &Tile| tile.eps_t.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&read), bits(&tile()));
}

#[test]
fn every_change_of_a_bit_and_every_cut_is_noticed() {
    let bytes = tile().to_bytes(LABEL);
    for bit in 0..8 * bytes.len() {
        let mut changed = bytes.clone();
        changed[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(Tile::from_bytes(&changed, LABEL, 3), None, "bit {bit}");
    }
    for length in 0..bytes.len() {
        assert_eq!(Tile::from_bytes(&bytes[..length], LABEL, 3), None, "{length} bytes");
    }
    let longer = [&bytes[..], b"\0"].concat();
    assert_eq!(Tile::from_bytes(&longer, LABEL, 3), None);
}

#[test]
fn a_tile_of_another_map_place_or_size_is_refused() {
    let bytes = tile().to_bytes(LABEL);
    assert_eq!(Tile::from_bytes(&bytes, "a map\ntile 4\n", 3), None);
    assert_eq!(Tile::from_bytes(&bytes, "a map\ntile 10\n", 3), None);
    for points in [0, 2, 4, usize::MAX / 16] {
        assert_eq!(Tile::from_bytes(&bytes, LABEL, points), None, "{points}");
    }
}
