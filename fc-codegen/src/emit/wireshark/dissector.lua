
-- The fields of frames and bodies.

-- Wireshark may have a protocol with this name already. `fc` is Fibre Channel.
local is_free, proto = pcall(Proto, spec.id, spec.title)
if not is_free then
  proto = Proto(spec.id .. "_protocol", spec.title)
end
local prefix = spec.id .. "."
local fields, by_path, header_fields = {}, {}, {}

-- A filter name has letters, digits, `_`, `-` and `.` only.
local function filter_name(path)
  return prefix .. (path:gsub("[^%w_.-]", "_"))
end

local function add_field(field)
  fields[#fields + 1] = field
  return field
end

local makers = {
  boolean = ProtoField.bool,
  int32 = ProtoField.int32,
  uint32 = ProtoField.uint32,
  int64 = ProtoField.int64,
  uint64 = ProtoField.uint64,
  double = ProtoField.double,
  string = ProtoField.string,
}

for _, field in ipairs(spec.header) do
  local name = filter_name("header." .. field.wire)
  local made
  if field.is_bytes then
    made = ProtoField.bytes(name, field.wire, base.SPACE, field.text)
  else
    local shown = field.role == "code" and base.HEX or base.DEC
    made = ProtoField["uint" .. field.size * 8](name, field.wire, shown, nil, nil, field.text)
  end
  header_fields[field] = add_field(made)
end

for _, field in ipairs(spec.fields) do
  local path, kind, text = field[1], field[2], field[3]
  local name, label = filter_name(path), path:match("[^.]+$") or path
  local made
  if kind == "boolean" then
    made = makers.boolean(name, label, base.NONE, nil, nil, text)
  elseif kind == "double" or kind == "string" then
    made = makers[kind](name, label, text)
  else
    made = makers[kind](name, label, base.DEC, nil, nil, text)
  end
  by_path[path] = { field = add_field(made), kind = kind, values = field[4] }
end

local f_operation = add_field(ProtoField.string(prefix .. "operation", "Operation"))
local f_direction = add_field(ProtoField.string(prefix .. "direction", "Direction"))
local f_error = add_field(ProtoField.string(prefix .. "error", "Error"))
local f_unknown = add_field(ProtoField.string(prefix .. "unknown_key", "Unknown key"))
local f_request = add_field(ProtoField.framenum(prefix .. "request_in", "Request in", base.NONE, frametype.REQUEST))
local f_response = add_field(ProtoField.framenum(prefix .. "response_in", "Response in", base.NONE, frametype.RESPONSE))
local f_elapsed = add_field(ProtoField.relative_time(prefix .. "elapsed", "Time since the request"))
proto.fields = fields

-- The first failed check of a frame determines its error. Other packages of the protocol use the same names.
local errors = {}
local experts = {}
for name, text in pairs({
  bad_head = "No frame begins here",
  short_frame = "The total length is less than the header",
  frame_too_long = "The total length exceeds the limit",
  unknown_kind = "Unknown kind",
  reserved_kind = "Reserved kind",
  unknown_encoding = "Unknown encoding",
  bad_digest = "The digest does not match the data",
  bad_gzip = "The data is not a complete gzip member",
  plain_length_mismatch = "The length before compression does not match the data",
  inflated_too_long = "Exceeds the limit after decompression",
  inflates_too_much = "Grows by more than the limit when decompressed",
  not_utf8 = "Not UTF-8",
  bad_json = "Not valid JSON",
  not_an_object = "The body is not an object",
  too_deep = "Nested too deeply",
}) do
  errors[name] = ProtoExpert.new(prefix .. "expert." .. name, text, expert.group.MALFORMED, expert.severity.ERROR)
  experts[#experts + 1] = errors[name]
end
local unchecked = ProtoExpert.new(
  prefix .. "expert.digest_not_checked",
  "The data is longer than the limit of the preferences, so its digest was not checked",
  expert.group.CHECKSUM,
  expert.severity.NOTE
)
experts[#experts + 1] = unchecked
proto.experts = experts
proto.prefs.check_bytes = Pref.uint("Check digests up to (bytes)", 65536, "Lua computes digests slowly. 0 checks none.")

local function report(tree, range, name)
  tree:add(f_error, range, name):set_generated()
  tree:add_proto_expert_info(errors[name])
end

-- Bits and digests.

local bits = rawget(_G, "bit32") or rawget(_G, "bit")
if not bits then
  -- Lua 5.3 and newer have operators. An older Lua could not read them.
  bits = assert(load([[return {
    band = function(a, b) return a & b end, bor = function(a, b) return a | b end,
    bxor = function(a, b) return a ~ b end, bnot = function(a) return ~a & 0xFFFFFFFF end,
    lshift = function(a, n) return (a << n) & 0xFFFFFFFF end, rshift = function(a, n) return (a & 0xFFFFFFFF) >> n end,
  }]]))()
end
local band, bor, bxor, bnot, lshift, rshift = bits.band, bits.bor, bits.bxor, bits.bnot, bits.lshift, bits.rshift
local WORD = 4294967296

local crc_table = {}
for byte = 0, 255 do
  local crc = byte
  for _ = 1, 8 do
    if band(crc, 1) == 1 then
      crc = bxor(rshift(crc, 1), 0xEDB88320)
    else
      crc = rshift(crc, 1)
    end
  end
  crc_table[byte] = crc
end

local function crc32(text)
  local crc = 0xFFFFFFFF
  for at = 1, #text do
    crc = bxor(rshift(crc, 8), crc_table[band(bxor(crc, text:byte(at)), 0xFF)])
  end
  return bnot(crc) % WORD
end

local md5_add = {}
for index = 1, 64 do
  md5_add[index] = math.floor(math.abs(math.sin(index)) * WORD)
end
local md5_shift = { { 7, 12, 17, 22 }, { 5, 9, 14, 20 }, { 4, 11, 16, 23 }, { 6, 10, 15, 21 } }

local function little(number, count)
  local out = {}
  for index = 1, count do
    out[index] = string.char(number % 256)
    number = math.floor(number / 256)
  end
  return table.concat(out)
end

local function md5(text)
  local padded = text .. "\128" .. ("\0"):rep((55 - #text) % 64) .. little(#text * 8, 8)
  local a0, b0, c0, d0 = 0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476
  local word = {}
  for block = 1, #padded, 64 do
    for index = 0, 15 do
      local one, two, three, four = padded:byte(block + index * 4, block + index * 4 + 3)
      word[index] = one + two * 256 + three * 65536 + four * 16777216
    end
    local a, b, c, d = a0, b0, c0, d0
    for step = 0, 63 do
      local round = math.floor(step / 16)
      local mix, index
      if round == 0 then
        mix, index = bxor(d, band(b, bxor(c, d))), step
      elseif round == 1 then
        mix, index = bxor(c, band(d, bxor(b, c))), (5 * step + 1) % 16
      elseif round == 2 then
        mix, index = bxor(b, bxor(c, d)), (3 * step + 5) % 16
      else
        mix, index = bxor(c, bor(b, bnot(d))), (7 * step) % 16
      end
      local sum = (a + mix + md5_add[step + 1] + word[index]) % WORD
      local shift = md5_shift[round + 1][step % 4 + 1]
      a, d, c = d, c, b
      b = (b + bor(lshift(sum, shift), rshift(sum, 32 - shift))) % WORD
    end
    a0, b0, c0, d0 = (a0 + a) % WORD, (b0 + b) % WORD, (c0 + c) % WORD, (d0 + d) % WORD
  end
  return little(a0, 4) .. little(b0, 4) .. little(c0, 4) .. little(d0, 4)
end

-- JSON (RFC 8259), with the position of each value.

local function is_utf8(text)
  local at, length = 1, #text
  while at <= length do
    at = text:find("[\128-\255]", at)
    if not at then
      return true
    end
    local lead, second = text:byte(at, at + 1)
    local count, least, most = 0, 0x80, 0xBF
    if lead >= 0xC2 and lead <= 0xDF then
      count = 1
    elseif lead >= 0xE0 and lead <= 0xEF then
      count = 2
      least = lead == 0xE0 and 0xA0 or 0x80
      most = lead == 0xED and 0x9F or 0xBF
    elseif lead >= 0xF0 and lead <= 0xF4 then
      count = 3
      least = lead == 0xF0 and 0x90 or 0x80
      most = lead == 0xF4 and 0x8F or 0xBF
    else
      return false
    end
    if not second or second < least or second > most then
      return false
    end
    for offset = 2, count do
      local byte = text:byte(at + offset)
      if not byte or byte < 0x80 or byte > 0xBF then
        return false
      end
    end
    at = at + count + 1
  end
  return true
end

local function encoded(point)
  if point < 0x80 then
    return string.char(point)
  elseif point < 0x800 then
    return string.char(0xC0 + math.floor(point / 64), 0x80 + point % 64)
  elseif point < 0x10000 then
    return string.char(0xE0 + math.floor(point / 4096), 0x80 + math.floor(point / 64) % 64, 0x80 + point % 64)
  end
  local high = 0xF0 + math.floor(point / 262144)
  return string.char(high, 0x80 + math.floor(point / 4096) % 64, 0x80 + math.floor(point / 64) % 64, 0x80 + point % 64)
end

local escapes = { b = "\b", f = "\f", n = "\n", r = "\r", t = "\t", ['"'] = '"', ["\\"] = "\\", ["/"] = "/" }

local function unescaped(text)
  text = text:gsub("\\u([dD][89abAB]%x%x)\\u([dD][c-fC-F]%x%x)", function(high, low)
    return encoded(0x10000 + (tonumber(high, 16) - 0xD800) * 1024 + tonumber(low, 16) - 0xDC00)
  end)
  text = text:gsub("\\u(%x%x%x%x)", function(digits)
    local point = tonumber(digits, 16)
    return (point < 0xD800 or point > 0xDFFF) and encoded(point) or "?"
  end)
  return (text:gsub('\\(["\\/bfnrt])', escapes))
end

local function skip(text, at)
  return text:find("[^ \t\r\n]", at) or #text + 1
end

-- Returns the position after a string, or nothing.
local function string_end(text, at)
  if text:sub(at, at) ~= '"' then
    return nil
  end
  at = at + 1
  while true do
    local stop = text:find('["\\%c]', at)
    if not stop then
      return nil
    end
    local found = text:sub(stop, stop)
    if found == '"' then
      return stop + 1
    elseif found == "\\" then
      local escape = text:sub(stop + 1, stop + 1)
      if escape == "u" then
        if not text:find("^%x%x%x%x", stop + 2) then
          return nil
        end
        at = stop + 6
      elseif escapes[escape] then
        at = stop + 2
      else
        return nil
      end
    elseif found == "\127" then
      at = stop + 1
    else
      return nil
    end
  end
end

local function number_end(text, at)
  local _, stop = text:find("^%-?%d+", at)
  if not stop or text:find("^%-?0%d", at) then
    return nil
  end
  if text:find("^%.", stop + 1) then
    _, stop = text:find("^%.%d+", stop + 1)
    if not stop then
      return nil
    end
  end
  if text:find("^[eE]", stop + 1) then
    _, stop = text:find("^[eE][+-]?%d+", stop + 1)
    if not stop then
      return nil
    end
  end
  return stop + 1
end

local value

-- Returns an object or a list, or nothing and the name of the error.
local function container(text, at, depth, closer, is_object)
  local node = { kind = is_object and "object" or "list", from = at, items = {} }
  if depth >= spec.json_depth then
    return nil, "too_deep"
  end
  at = skip(text, at + 1)
  if text:sub(at, at) == closer then
    node.to = at
    return node
  end
  while true do
    local key
    if is_object then
      local stop = string_end(text, at)
      if not stop then
        return nil, "bad_json"
      end
      key = unescaped(text:sub(at + 1, stop - 2))
      at = skip(text, stop)
      if text:sub(at, at) ~= ":" then
        return nil, "bad_json"
      end
      at = skip(text, at + 1)
    end
    local item, problem = value(text, at, depth + 1)
    if not item then
      return nil, problem
    end
    item.key = key
    node.items[#node.items + 1] = item
    at = skip(text, item.to + 1)
    local found = text:sub(at, at)
    if found == closer then
      node.to = at
      return node
    elseif found ~= "," then
      return nil, "bad_json"
    end
    at = skip(text, at + 1)
  end
end

local words = { t = "true", f = "false", n = "null" }

value = function(text, at, depth)
  local first = text:sub(at, at)
  if first == "{" then
    return container(text, at, depth, "}", true)
  elseif first == "[" then
    return container(text, at, depth, "]", false)
  elseif first == '"' then
    local stop = string_end(text, at)
    if not stop then
      return nil, "bad_json"
    end
    return { kind = "string", from = at, to = stop - 1, text = unescaped(text:sub(at + 1, stop - 2)) }
  end
  local word = words[first]
  if word and text:sub(at, at + #word - 1) == word then
    return { kind = word, from = at, to = at + #word - 1, text = word }
  end
  local stop = number_end(text, at)
  if not stop then
    return nil, "bad_json"
  end
  return { kind = "number", from = at, to = stop - 1, text = text:sub(at, stop - 1) }
end

-- Returns the object of a body, or nothing and the name of the error.
local function parse(text)
  if not is_utf8(text) then
    return nil, "not_utf8"
  end
  if text == "" then
    return { kind = "object", from = 1, to = 0, items = {} }
  end
  local node, problem = value(text, skip(text, 1), 0)
  if not node then
    return nil, problem
  end
  if skip(text, node.to + 1) <= #text then
    return nil, "bad_json"
  end
  if node.kind ~= "object" then
    return nil, "not_an_object"
  end
  return node
end

-- Trees.

local function shown_value(known, node)
  local name = known.values and known.values[node.text]
  return name and (node.text .. " (" .. name .. ")") or node.text
end

local function add_leaf(tree, range, path, node)
  local known = by_path[path]
  local label = node.key or "item"
  if not known then
    tree:add(f_unknown, range, label .. ": " .. (node.text or node.kind))
    return
  end
  local kind, number = known.kind, tonumber(node.text)
  local item
  if kind == "string" then
    item = tree:add(known.field, range, node.text)
  elseif kind == "boolean" and (node.kind == "true" or node.kind == "false" or number) then
    item = tree:add(known.field, range, node.kind == "true" or (number or 0) ~= 0)
  elseif kind == "double" and number then
    item = tree:add(known.field, range, number)
  elseif number and kind ~= "boolean" then
    local whole = kind == "int64" and Int64.new(number) or kind == "uint64" and UInt64.new(number) or number
    item = tree:add(known.field, range, whole)
  else
    item = tree:add(range, "")
  end
  item:set_text(label .. ": " .. shown_value(known, node))
end

local function add_items(tree, tvb, path, items, is_list)
  for _, node in ipairs(items) do
    local range = tvb(node.from - 1, node.to - node.from + 1)
    local inner = is_list and path or (path == "" and node.key or path .. "." .. node.key)
    if node.items then
      local label = (node.key or "item") .. (node.kind == "list" and " [" .. #node.items .. "]" or "")
      add_items(tree:add(range, label), tvb, inner, node.items, node.kind == "list")
    else
      add_leaf(tree, range, inner, node)
    end
  end
end

-- Frames.

local head_length = math.max(#spec.request_head, #spec.response_head)

local function integer(tvb, offset, field)
  local range = tvb(offset + field.offset, field.size)
  if field.size > 4 then
    return (spec.little_endian and range:le_uint64() or range:uint64()):tonumber()
  end
  return spec.little_endian and range:le_uint() or range:uint()
end

local roles = {}
for _, field in ipairs(spec.header) do
  if field.role then
    roles[field.role] = field
  end
end

local function int_of(tvb, offset, role)
  local field = roles[role]
  return field and integer(tvb, offset, field)
end

-- Returns the direction of the frame whose head begins here.
local function direction_of(tvb, offset)
  local bytes = tvb:raw(offset, math.min(head_length, tvb:len() - offset))
  for _, direction in ipairs({ "response", "request" }) do
    local head = spec[direction .. "_head"]
    local count = math.min(#head, #bytes)
    if bytes:sub(1, count) == head:sub(1, count) then
      return direction
    end
  end
end

-- Returns the position of the next frame.
local function next_head(tvb, offset)
  local text = tvb:raw(offset)
  local nearest
  for _, head in ipairs({ spec.request_head, spec.response_head }) do
    local found = text:find(head, 1, true)
    if found and (not nearest or found < nearest) then
      nearest = found
    end
  end
  return nearest and offset + nearest - 1 or tvb:len()
end

local function digest_of(text)
  if spec.digest == "crc32" then
    local digest = little(crc32(text), 4)
    return spec.little_endian and digest or digest:reverse()
  end
  return md5(text)
end

-- Returns the decompressed data, or nothing and the name of the error.
local function inflated(range, packed, plain_length)
  if plain_length > spec.inflated_bytes then
    return nil, "inflated_too_long"
  end
  if plain_length > spec.inflate_free and plain_length > spec.inflate_ratio * #packed then
    return nil, "inflates_too_much"
  end
  if packed:sub(1, 3) ~= "\31\139\8" or #packed < 18 then
    return nil, "bad_gzip"
  end
  -- Wireshark 4.2 renames the function.
  local is_done, plain = pcall(function()
    return range:uncompress_zlib("Decompressed")
  end)
  if not is_done then
    is_done, plain = pcall(function()
      return range:uncompress("Decompressed")
    end)
  end
  if not is_done or not plain then
    return nil, "bad_gzip"
  end
  local text = plain:raw()
  if #text <= proto.prefs.check_bytes and packed:sub(-8) ~= little(crc32(text), 4) .. little(#text % WORD, 4) then
    return nil, "bad_gzip"
  end
  if #text ~= plain_length then
    return nil, "plain_length_mismatch"
  end
  return plain
end

-- Checks a frame in the order of all packages. Returns the data as a range, or nothing and the name of the error.
local function checked(tvb, offset, total, tree)
  local kind = spec.kinds[int_of(tvb, offset, "kind")]
  if not kind then
    return nil, "unknown_kind"
  end
  if kind.role == "reserved" then
    return nil, "reserved_kind"
  end
  local encoding = roles.encoding and spec.encodings[int_of(tvb, offset, "encoding")] or (not roles.encoding and "plain")
  if not encoding then
    return nil, "unknown_encoding"
  end
  local length = total - spec.header_length
  local range = length > 0 and tvb(offset + spec.header_length, length) or nil
  local text = range and range:raw() or ""
  if roles.digest then
    if #text > proto.prefs.check_bytes then
      tree:add_proto_expert_info(unchecked)
    elseif tvb:raw(offset + roles.digest.offset, roles.digest.size) ~= digest_of(text) then
      return nil, "bad_digest"
    end
  end
  local plain_length = int_of(tvb, offset, "plain_length")
  if encoding == "plain" then
    local is_zero = spec.zero_when_plain and plain_length == 0
    if plain_length and plain_length ~= length and not is_zero then
      return nil, "plain_length_mismatch"
    end
    return range, nil, text
  end
  if not range then
    return nil, "bad_gzip"
  end
  local plain, problem = inflated(range, text, plain_length or spec.inflated_bytes)
  return plain, problem, plain and plain:raw()
end

-- Requests that wait for their response, and the links between frames that were found.
local waiting, links = {}, {}

function proto.init()
  waiting, links = {}, {}
end

local function link(pinfo, tree, offset, direction, id)
  local here = pinfo.number .. ":" .. offset
  local from, to = tostring(pinfo.src) .. " " .. pinfo.src_port, tostring(pinfo.dst) .. " " .. pinfo.dst_port
  if not pinfo.visited then
    if direction == "request" then
      waiting[from .. " " .. to .. " " .. id] = { number = pinfo.number, time = pinfo.abs_ts, here = here }
    else
      local key = to .. " " .. from .. " " .. id
      local request = waiting[key]
      if request then
        waiting[key] = nil
        links[here] = { request = request.number, time = pinfo.abs_ts - request.time }
        links[request.here] = { response = pinfo.number }
      end
    end
  end
  local found = links[here]
  if found and found.request then
    tree:add(f_request, found.request):set_generated()
    local seconds = math.floor(found.time)
    local nanos = math.floor((found.time - seconds) * 1000000000 + 0.5)
    tree:add(f_elapsed, NSTime.new(seconds, nanos)):set_generated()
  elseif found then
    tree:add(f_response, found.response):set_generated()
  end
end

local function add_header(tree, tvb, offset)
  for _, field in ipairs(spec.header) do
    local range = tvb(offset + field.offset, field.size)
    local item = spec.little_endian and not field.is_bytes and tree:add_le(header_fields[field], range)
      or tree:add(header_fields[field], range)
    local number = not field.is_bytes and integer(tvb, offset, field)
    if field.role == "kind" and spec.kinds[number] then
      item:append_text(" (" .. spec.kinds[number].name .. ")")
    elseif field.role == "encoding" and spec.encodings[number] then
      item:append_text(" (" .. spec.encodings[number] .. ")")
    end
  end
end

local function dissect_frame(tvb, offset, total, direction, pinfo, root)
  local frame = tvb(offset, total)
  local kind, code, id = int_of(tvb, offset, "kind"), int_of(tvb, offset, "code"), int_of(tvb, offset, "id")
  local operation = spec.operations[kind * 65536 + code]
  local name = operation and operation.name or string.format("0x%04X", code)
  local tree = root:add(proto, frame, spec.title .. ", " .. name .. " " .. direction)
  tree:add(f_operation, frame, name):set_generated()
  tree:add(f_direction, frame, direction):set_generated()
  add_header(tree, tvb, offset)
  local range, problem, text = checked(tvb, offset, total, tree)
  local mark = problem and " [" .. problem .. "]" or ""
  if problem then
    report(tree, frame, problem)
  else
    local is_stream = spec.kinds[kind].role == "stream"
    if not is_stream then
      link(pinfo, tree, offset, direction, kind .. " " .. code .. " " .. (id or 0))
    end
    if not is_stream or (operation and operation.is_json) then
      local node, wrong = parse(text)
      if wrong then
        report(tree, range or frame, wrong)
        mark = " [" .. wrong .. "]"
      elseif range then
        local body = tree:add(range, "Body")
        local data = range:tvb()
        for _, item in ipairs(node.items) do
          local is_envelope = not is_stream and spec.envelope[direction][item.key]
          add_items(body, data, is_envelope and "" or name, { item }, false)
        end
      end
    end
  end
  local shown = name .. " " .. direction .. (id and " id=" .. id or "") .. mark
  pinfo.cols.info:append((offset > 0 and ", " or "") .. shown)
end

local function add_damage(tvb, offset, name, root)
  local stop = next_head(tvb, offset + 1)
  local range = tvb(offset, stop - offset)
  report(root:add(proto, range, spec.title .. ", damaged bytes"), range, name)
  return stop
end

function proto.dissector(tvb, pinfo, root)
  pinfo.cols.protocol = spec.id:upper()
  pinfo.cols.info:clear()
  local offset, length = 0, tvb:len()
  local total_field = roles.total_length
  while offset < length do
    local rest = length - offset
    local direction = direction_of(tvb, offset)
    local total
    if direction and rest >= total_field.offset + total_field.size then
      total = integer(tvb, offset, total_field)
    end
    if not direction then
      offset = add_damage(tvb, offset, "bad_head", root)
    elseif total and total > spec.frame_bytes then
      offset = add_damage(tvb, offset, "frame_too_long", root)
    elseif total and total < spec.header_length then
      offset = add_damage(tvb, offset, "short_frame", root)
    elseif not total or rest < total then
      pinfo.desegment_offset = offset
      pinfo.desegment_len = total and total - rest or DESEGMENT_ONE_MORE_SEGMENT
      return length
    else
      dissect_frame(tvb, offset, total, direction, pinfo, root)
      offset = offset + total
    end
  end
  return length
end

local tcp = DissectorTable.get("tcp.port")
for _, port in ipairs(spec.ports) do
  tcp:add(port, proto)
end
