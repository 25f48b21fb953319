// Errors of frames and bodies: the one place that spells their names.

import type { Text } from './protocol.ts'

/** The error found in a frame or a body. The golden frames and every implementation of the protocol use these names. */
export type ErrorName =
  | 'bad_head'
  | 'short_frame'
  | 'frame_too_long'
  | 'unknown_kind'
  | 'reserved_kind'
  | 'unknown_encoding'
  | 'bad_digest'
  | 'bad_gzip'
  | 'plain_length_mismatch'
  | 'inflated_too_long'
  | 'truncated'
  | 'not_utf8'
  | 'bad_json'
  | 'not_an_object'
  | 'wrong_type'
  | 'missing_field'
  | 'duplicate_key'
  | 'lone_surrogate'
  | 'out_of_range'
  | 'bad_length'
  | 'bad_pattern'
  | 'unknown_value'
  | 'no_variant'
  | 'too_deep'
  | 'bad_base64'

/** A description of each error for a reader. */
export const errorText: Readonly<Record<ErrorName, Text>> = {
  bad_head: { zh: '帧头不对：这不是一帧的开头', en: 'Wrong head: no frame starts here' },
  short_frame: { zh: '总长度小于包头长度', en: 'The total length is shorter than the header' },
  frame_too_long: { zh: '总长度超过上限', en: 'The total length exceeds the limit' },
  truncated: { zh: '字节不够：帧不完整', en: 'Bytes are missing: the frame is incomplete' },
  unknown_kind: { zh: '未知的数据类型', en: 'Unknown kind' },
  reserved_kind: { zh: '预留的数据类型，一律拒绝', en: 'Reserved kind, always refused' },
  unknown_encoding: { zh: '未知的压缩方式', en: 'Unknown encoding' },
  bad_digest: { zh: '摘要与数据不符', en: 'The digest does not match the data' },
  bad_gzip: { zh: '数据不是完整的 gzip', en: 'The data is not a complete gzip member' },
  plain_length_mismatch: { zh: '压缩前长度与实际不符', en: 'The length before compression does not match the data' },
  inflated_too_long: { zh: '解压后超过上限', en: 'Exceeds the limit after decompression' },
  not_utf8: { zh: '不是 UTF-8 文本', en: 'Not UTF-8' },
  bad_json: { zh: '不是合法的 JSON', en: 'Not valid JSON' },
  not_an_object: { zh: '最外层应为对象', en: 'The outermost value must be an object' },
  wrong_type: { zh: '类型不对', en: 'Wrong type' },
  missing_field: { zh: '缺少必填字段', en: 'A required key is missing' },
  duplicate_key: { zh: '同一个键出现了两次', en: 'A key occurs twice' },
  lone_surrogate: {
    zh: '字符串里有落单的半个代理对，不是合法的 Unicode 文本',
    en: 'A string holds half of a surrogate pair, which is not Unicode text',
  },
  out_of_range: { zh: '取值超出范围', en: 'Out of range' },
  bad_length: { zh: '长度不符', en: 'Wrong length' },
  bad_pattern: { zh: '格式不符', en: 'Does not match the pattern' },
  unknown_value: { zh: '取值不在封闭枚举之内', en: 'Not a value of this closed enum' },
  no_variant: { zh: '不符合任何一种形式', en: 'None of the forms fits' },
  too_deep: { zh: '嵌套过深', en: 'Nested too deeply' },
  bad_base64: { zh: '不是 base64', en: 'Not base64' },
}
