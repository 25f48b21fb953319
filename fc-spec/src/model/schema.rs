//! The JSON Schemas of types with their own form in a dump.

/// Implements `JsonSchema` with a fixed schema.
macro_rules! fixed_schema {
    ($Type:ty, $schema:tt) => {
        impl schemars::JsonSchema for $Type {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($Type).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!($schema)
            }
        }
    };
}

pub(super) use fixed_schema;
