//! Tests of the numbers that the contact and its solutions need.

mod double_doubles;
mod roots;
