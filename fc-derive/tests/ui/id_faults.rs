//! Ids with invalid inner types.

use fc_derive::Id;

#[derive(Id)]
struct Named {
    id: i64,
}

#[derive(Id)]
struct Pair(i64, i64);

#[derive(Id)]
struct Size(f64);

#[derive(Id)]
struct Of<T>(T);

#[derive(Id)]
enum Either {
    One,
}

#[derive(Id)]
#[fc(repr = u8)]
struct Odd(u8);

fn main() {}
