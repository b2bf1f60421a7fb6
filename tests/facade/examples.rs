//! The examples run, and hold what they assert.

#[path = "../../examples/arenstorf.rs"]
mod arenstorf;
#[path = "../../examples/belt_atlas/main.rs"]
mod belt_atlas;
#[path = "../../examples/bouncing_ball.rs"]
mod bouncing_ball;
#[path = "../../examples/friction_belt.rs"]
mod friction_belt;
#[path = "../../examples/impact_oscillator.rs"]
mod impact_oscillator;
#[path = "../../examples/relay.rs"]
mod relay;

#[test]
fn arenstorf() {
    arenstorf::main().expect("an orbit");
}

#[test]
fn belt_atlas() {
    belt_atlas::main().expect("an atlas");
}

#[test]
fn bouncing_ball() {
    bouncing_ball::main().expect("balls at rest");
}

#[test]
fn friction_belt() {
    friction_belt::main().expect("a limit cycle");
}

#[test]
fn impact_oscillator() {
    impact_oscillator::main().expect("turns");
}

#[test]
fn relay() {
    relay::main().expect("switches");
}
