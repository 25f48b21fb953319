//! Messages as tables.

use crate::support::small;
use fc_reflect::{Direction, Reflector};
use fc_spec::model::Lang;
use fc_workshop::table::table;

#[test]
fn raw_json_takes_one_line() {
    let model = small();
    let reflector = Reflector::new(&model);
    let operation = model.operation("set_light");
    let body = b"{\"lvl\":7,\"any\":[1,\n\t2]}";
    let message = reflector
        .message(operation, Direction::Request, body)
        .unwrap();
    let table = table(&message.body.unwrap(), Lang::En);
    let line = table.lines().find(|line| line.starts_with("any")).unwrap();
    assert!(line.contains("[1,  2]"), "{table}");
}
