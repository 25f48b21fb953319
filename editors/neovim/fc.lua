-- Neovim 0.8 or later: in ~/.config/nvim/plugin/fc.lua.
vim.api.nvim_create_autocmd('FileType', {
  pattern = 'yaml',
  callback = function(event)
    local found = vim.fs.find({ 'fc.yaml', 'spec/protocol.yaml' }, {
      path = vim.fs.dirname(vim.api.nvim_buf_get_name(event.buf)),
      upward = true,
    })[1]
    if not found then
      return
    end
    local root = found:gsub('/fc%.yaml$', ''):gsub('/spec/protocol%.yaml$', '')
    vim.lsp.start({
      name = 'fcproto',
      cmd = { 'fcproto', 'lsp' },
      root_dir = root,
      init_options = { lang = vim.env.LANG },
    })
  end,
})
