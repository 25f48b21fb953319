//! States need an order, and only variants with a value can be states.

#[derive(fc_derive::OpenEnum)]
#[fc(repr = u8)]
enum A {
    #[fc(value = 1, then(B))]
    A,
    #[fc(value = 2)]
    B,
}

#[derive(fc_derive::OpenEnum)]
#[fc(repr = u8, order = "normal")]
enum C {
    #[fc(value = 1, then(Gone))]
    A,
    #[fc(other, final)]
    B(u8),
}

#[derive(fc_derive::OpenEnum)]
#[fc(repr = u8, order = "usual")]
enum D {
    #[fc(value = 1)]
    A,
}

fn main() {}
