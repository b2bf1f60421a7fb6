//! Places in panels, and the values there.

use stickslip_figure::canvas::panel::{Edge, LINEAR, Panel, Scale};
use stickslip_figure::canvas::shape::Rectangle;

#[test]
fn places_and_values_are_inverse() {
    let frame = Rectangle { left: 10.0, top: 20.0, width: 300.0, height: 100.0 };
    for scale in [Scale::Linear, Scale::Logarithmic] {
        let panel = Panel { frame, x: (0.5, 200.0), y: (0.1, 10.0), scales: (scale, scale) };
        let (x, y) = panel.value(panel.place((7.0, 0.3)));
        assert!((x - 7.0).abs() < 1e-12 && (y - 0.3).abs() < 1e-14);
        let (left, top) = panel.place((10.0, 1.0));
        let middle = (frame.left + 0.5 * frame.width, frame.top + 0.5 * frame.height);
        assert_eq!((left - middle.0).abs() < 1e-9, scale == Scale::Logarithmic);
        assert_eq!((top - middle.1).abs() < 1e-9, scale == Scale::Logarithmic);
    }
}

#[test]
fn a_power_of_ten_that_labels_leave_out_follows_the_name() {
    let frame = Rectangle { left: 0.0, top: 0.0, width: 100.0, height: 100.0 };
    for (range, power) in
        [((0.0, 2e6), " (×10^{6})"), ((-3e-5, 3e-5), " (×10^{−5})"), ((0.0, 99999.0), "")]
    {
        let linear = Panel { frame, x: range, y: range, scales: LINEAR };
        assert_eq!(linear.power(Edge::Left), power);
        let scales = (Scale::Logarithmic, Scale::Logarithmic);
        assert_eq!(Panel { scales, ..linear }.power(Edge::Left), "");
    }
}

#[test]
fn points_have_places() {
    let frame = Rectangle { left: 10.0, top: 20.0, width: 100.0, height: 50.0 };
    let panel = Panel { frame, x: (0.0, 2.0), y: (-1.0, 1.0), scales: LINEAR };
    assert_eq!(panel.place((0.0, -1.0)), (10.0, 70.0));
    assert_eq!(panel.place((2.0, 1.0)), (110.0, 20.0));
}
