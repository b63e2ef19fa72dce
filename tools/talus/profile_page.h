/* The page of `talus profile --html`, made of profile_page.html by the Makefile; ends in a zero. */
#ifndef TALUS_TOOL_PROFILE_PAGE_H
#define TALUS_TOOL_PROFILE_PAGE_H

extern const unsigned char profile_page[];

#endif
